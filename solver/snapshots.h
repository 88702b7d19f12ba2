#pragma once

#include "formfactor/ray_caster.h"
#include "meshing/patch_mesh.h"
#include "solver/gather.h"
#include "solver/radiosity.h"

#include <stop_token>
#include <vector>

namespace patchlight {

/// The linear reconstruction of the progressive solution after so many shots, one for each entry of `shots`
/// (ascending, ≥ 1), as the lecture shows it after 1, 2, 3 and 16. Shooters are coarse (a flat emitter is one),
/// receivers are the mesh's vertices: each sees the shooter by Lambert's formula times the visible fraction
/// [WallaceElmquistHaines89]. Throws Interrupted.
std::vector<VertexRadiosity> progressive_snapshots(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                                   const std::vector<int>& shots, const GatherOptions& options,
                                                   std::stop_token stop = {});

}  // namespace patchlight
