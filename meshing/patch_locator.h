#pragma once

#include "meshing/patch_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// Finds the patch that contains a point of a surface: a uniform grid over each surface's own plane.
class PatchLocator {
public:
    explicit PatchLocator(const PatchMesh& mesh);

    /// The patch of `surface` that contains the point with plane coordinates (x, y), or the nearest one among
    /// those of its grid cell when rounding puts the point just outside all. Invalid only if the surface has no patch.
    PatchId locate(SurfaceId surface, float x, float y) const;

    /// Barycentric coordinates of the point in a patch, clamped into it; they sum to 1.
    std::array<double, 3> barycentric(PatchId patch, const Vec2& q) const;

private:
    struct Grid {
        float x0 = 0, y0 = 0, inverse_cell = 0;
        std::int32_t nx = 0, ny = 0;
        std::uint32_t first_cell = 0;
    };
    /// Edge functions of a patch, scaled so that they are barycentric coordinates: w_k = a·x + b·y + c.
    struct Edges {
        float a0, b0, c0, a1, b1, c1;
    };
    const PatchMesh* mesh_;
    std::vector<Grid> grids_;
    std::vector<std::uint32_t> cell_start_;
    std::vector<std::uint32_t> cell_patches_;
    std::vector<Edges> edges_;
};

}  // namespace patchlight
