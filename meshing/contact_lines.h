#pragma once

#include "meshing/scene.h"

#include <vector>

namespace patchlight {

/// Where light jumps on a surface because something stands on it or passes through it: edges of the scene's triangles
/// with the surface on both sides, and in front of it a triangle that rises from there by more than `snap`, m.
/// Collinear pieces that meet end to end are one line. Sorted by surface, start and end; each line once, its ends at
/// the plane coordinates of scene vertices.
std::vector<SurfaceLine> find_contact_lines(const Scene& scene, double snap);

}  // namespace patchlight
