#pragma once

#include "meshing/patch_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// Finds the patch that contains a point of a surface: a uniform grid over each surface's own plane, whose
/// crowded cells hold a finer grid. Keeps a reference to the mesh.
class PatchLocator {
public:
    explicit PatchLocator(const PatchMesh& mesh);

    /// The patch of `surface` that contains the point with plane coordinates (x, y), or the nearest one among
    /// those of its grid cell when rounding puts the point just outside all. Invalid only if the surface has no patch.
    PatchId locate(SurfaceId surface, float x, float y) const;

    /// The same for many hits at once, in stages that fetch ahead: on a large mesh most of a look-up is waiting for
    /// memory. surface[i] ≥ `no_surface` gives an invalid patch.
    void locate(std::span<const std::uint32_t> surface, std::span<const float> x, std::span<const float> y,
                std::uint32_t no_surface, std::span<PatchId> patches) const;

    /// Barycentric coordinates of the plane point q in a patch, clamped into it; they sum to 1.
    std::array<double, 3> barycentric(PatchId patch, const Vec2& q) const;

private:
    struct Grid {
        float x0 = 0, y0 = 0, inverse_dx = 0, inverse_dy = 0;
        std::int32_t nx = 0, ny = 0;
        std::uint32_t first_cell = 0;
    };
    /// A leaf lists entries [first, first + count); count 0 means that `first` is a finer grid's index.
    struct Cell {
        std::uint32_t first = 0, count = 0;
    };
    /// Two barycentric coordinates as functions of the plane: w = a·(x − x0) + b·(y − y0) + c; the third is 1 less
    /// both.
    struct Entry {
        float x0, y0, a0, b0, c0, a1, b1, c1;
        std::uint32_t patch;
    };
    struct Box {
        float x0, y0, x1, y1;
    };

    std::uint32_t cell_index(const Grid& grid, float x, float y) const;
    PatchId search(const Cell& cell, float x, float y) const;
    std::uint32_t build_grid(const Box& box, const std::vector<std::uint32_t>& patches, int depth);
    Entry make_entry(std::uint32_t patch) const;
    bool overlaps(std::uint32_t patch, const Box& box) const;

    const PatchMesh* mesh_;
    std::vector<std::uint32_t> surface_grid_;
    std::vector<Grid> grids_;
    std::vector<Cell> cells_;
    std::vector<Entry> entries_;
};

}  // namespace patchlight
