#pragma once

#include "meshing/patch_locator.h"
#include "solver/radiosity.h"

namespace patchlight {

/// A solution's B as a function over the surfaces: what probing, pictures and errors are made from. Linear elements
/// interpolate a patch's corners; quadratic ones are the six-node Lagrange polynomial through corners and middles of
/// edges, w_i (2 w_i − 1) and 4 w_i w_j, cut at 0 below, where it may overshoot beside a shadow.
/// All it refers to must live as long as this.
struct ElementLight {
    const PatchMesh& mesh;
    const PatchLocator& locator;
    const VertexRadiosity& vertex_B;
    const MidpointRadiosity* middle_B = nullptr;  ///< null or empty: linear elements

    /// W/m² at plane coordinates q of the patch's surface, which are clamped into the patch.
    Rgb at(PatchId patch, const Vec2& q) const;
    /// The same where the patch isn't known; 0 on a surface that has no patches.
    Rgb at(SurfaceId surface, const Vec2& q) const;
};

}  // namespace patchlight
