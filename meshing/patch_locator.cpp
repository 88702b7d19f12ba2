#include "meshing/patch_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace patchlight {

namespace {

constexpr std::uint32_t no_grid = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t crowded = 10;  // entries of a cell beyond which a finer grid pays
constexpr int deepest = 6;

}  // namespace

PatchLocator::PatchLocator(const PatchMesh& mesh) : mesh_(&mesh), surface_grid_(mesh.surface_count(), no_grid)
{
    for (std::uint32_t s = 0; s < mesh.surface_count(); ++s) {
        const auto range = mesh.patches_of(SurfaceId(s));
        if (range.size() == 0) continue;
        Vec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
        for (const VertexId v : mesh.vertices_of(SurfaceId(s))) {
            low = glm::min(low, mesh.plane_position(v));
            high = glm::max(high, mesh.plane_position(v));
        }
        std::vector<std::uint32_t> patches(range.size());
        std::iota(patches.begin(), patches.end(), range.first);
        const Box box{static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(high.x),
                      static_cast<float>(high.y)};
        surface_grid_[s] = build_grid(box, patches, 0);
    }
}

PatchLocator::Entry PatchLocator::make_entry(std::uint32_t patch) const
{
    const auto c = mesh_->corners(PatchId(patch));
    const Vec2 p0 = mesh_->plane_position(c[0]), p1 = mesh_->plane_position(c[1]), p2 = mesh_->plane_position(c[2]);
    const double scale = 1 / cross2(p0, p1, p2);
    // Relative to the patch's own corner: differences of nearby floats lose nothing.
    const float x0 = static_cast<float>(p2.x), y0 = static_cast<float>(p2.y);
    const auto c_at = [&](double a, double b) { return static_cast<float>(a * (x0 - p2.x) + b * (y0 - p2.y)); };
    const double a0 = (p1.y - p2.y) * scale, b0 = (p2.x - p1.x) * scale;
    const double a1 = (p2.y - p0.y) * scale, b1 = (p0.x - p2.x) * scale;
    return {x0,
            y0,
            static_cast<float>(a0),
            static_cast<float>(b0),
            c_at(a0, b0),
            static_cast<float>(a1),
            static_cast<float>(b1),
            c_at(a1, b1),
            patch};
}

bool PatchLocator::overlaps(std::uint32_t patch, const Box& box) const
{
    const auto c = mesh_->corners(PatchId(patch));
    const std::array<Vec2, 3> p{mesh_->plane_position(c[0]), mesh_->plane_position(c[1]), mesh_->plane_position(c[2])};
    const Vec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    if (low.x > box.x1 || high.x < box.x0 || low.y > box.y1 || high.y < box.y0) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        // The box's corner that lies furthest to the left of the edge decides.
        const Vec2 edge = p[(k + 1) % 3] - p[k];
        const Vec2 far(edge.y > 0 ? box.x0 : box.x1, edge.x > 0 ? box.y1 : box.y0);
        if (cross2(p[k], p[(k + 1) % 3], far) < 0) return false;
    }
    return true;
}

std::uint32_t PatchLocator::build_grid(const Box& box, const std::vector<std::uint32_t>& patches, int depth)
{
    const double width = std::max<double>(box.x1 - box.x0, 1e-30), height = std::max<double>(box.y1 - box.y0, 1e-30);
    const double wanted = static_cast<double>(patches.size()) * (depth == 0 ? 2.0 : 1.0);
    Grid grid;
    grid.nx = std::clamp(static_cast<int>(std::lround(std::sqrt(wanted * width / height))), 1, 2048);
    grid.ny = std::clamp(static_cast<int>(std::lround(wanted / grid.nx)), 1, 2048);
    grid.x0 = box.x0;
    grid.y0 = box.y0;
    grid.inverse_dx = static_cast<float>(grid.nx / width);
    grid.inverse_dy = static_cast<float>(grid.ny / height);
    grid.first_cell = static_cast<std::uint32_t>(cells_.size());
    const auto index = static_cast<std::uint32_t>(grids_.size());
    grids_.push_back(grid);
    cells_.resize(cells_.size() + static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));

    // A margin of a hundredth of a cell: a float that rounds into the neighbouring cell still finds its patch.
    const float dx = static_cast<float>(width / grid.nx), dy = static_cast<float>(height / grid.ny);
    const auto cell_box = [&](int ix, int iy) {
        const float x = box.x0 + static_cast<float>(ix) * dx, y = box.y0 + static_cast<float>(iy) * dy;
        return Box{x - 0.01F * dx, y - 0.01F * dy, x + 1.01F * dx, y + 1.01F * dy};
    };
    std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(grid.nx) *
                                                  static_cast<std::size_t>(grid.ny));
    for (const std::uint32_t patch : patches) {
        Vec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
        for (const VertexId v : mesh_->corners(PatchId(patch))) {
            low = glm::min(low, mesh_->plane_position(v));
            high = glm::max(high, mesh_->plane_position(v));
        }
        const auto cell_at = [](double x, double x0, double cell, int n) {
            // Not of a number, too: where floats make nothing of a cell's width.
            const double at = std::floor((x - x0) / cell);
            return at > 0 ? static_cast<int>(std::min(at, static_cast<double>(n - 1))) : 0;
        };
        const int ix0 = cell_at(low.x - 0.02 * dx, box.x0, dx, grid.nx),
                  ix1 = cell_at(high.x + 0.02 * dx, box.x0, dx, grid.nx);
        const int iy0 = cell_at(low.y - 0.02 * dy, box.y0, dy, grid.ny),
                  iy1 = cell_at(high.y + 0.02 * dy, box.y0, dy, grid.ny);
        for (int iy = iy0; iy <= iy1; ++iy)
            for (int ix = ix0; ix <= ix1; ++ix)
                if (overlaps(patch, cell_box(ix, iy)))
                    lists[static_cast<std::size_t>(iy * grid.nx + ix)].push_back(patch);
    }
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const auto& list = lists[i];
        Cell cell;
        if (list.size() > crowded && depth < deepest && (lists.size() > 1 || depth == 0)) {
            const int ix = static_cast<int>(i) % grid.nx, iy = static_cast<int>(i) / grid.nx;
            cell = {build_grid(cell_box(ix, iy), list, depth + 1), 0};
        } else {
            cell = {static_cast<std::uint32_t>(entries_.size()), static_cast<std::uint32_t>(list.size())};
            for (const std::uint32_t patch : list) entries_.push_back(make_entry(patch));
            // Cells outside the polygon take any patch: a hit can come here by rounding only.
            if (list.empty()) {
                entries_.push_back(make_entry(patches.front()));
                cell.count = 1;
            }
        }
        cells_[grid.first_cell + i] = cell;
    }
    return index;
}

std::uint32_t PatchLocator::cell_index(const Grid& grid, float x, float y) const
{
    const int ix = std::clamp(static_cast<int>((x - grid.x0) * grid.inverse_dx), 0, grid.nx - 1);
    const int iy = std::clamp(static_cast<int>((y - grid.y0) * grid.inverse_dy), 0, grid.ny - 1);
    return grid.first_cell + static_cast<std::uint32_t>(iy * grid.nx + ix);
}

PatchId PatchLocator::search(const Cell& start, float x, float y) const
{
    Cell cell = start;
    while (cell.count == 0) cell = cells_[cell_index(grids_[cell.first], x, y)];
    float best = -std::numeric_limits<float>::max();
    std::uint32_t patch = entries_[cell.first].patch;
    for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
        const Entry& e = entries_[i];
        const float u = x - e.x0, v = y - e.y0;
        const float w0 = e.a0 * u + e.b0 * v + e.c0, w1 = e.a1 * u + e.b1 * v + e.c1;
        const float inside = std::min(std::min(w0, w1), 1 - w0 - w1);
        if (inside > best) {
            best = inside;
            patch = e.patch;
            if (inside >= 0) break;
        }
    }
    return PatchId(patch);
}

PatchId PatchLocator::locate(SurfaceId surface, float x, float y) const
{
    const std::uint32_t grid = surface_grid_[surface.value];
    return grid == no_grid ? PatchId() : search(cells_[cell_index(grids_[grid], x, y)], x, y);
}

void PatchLocator::locate(std::span<const std::uint32_t> surface, std::span<const float> x, std::span<const float> y,
                          std::uint32_t no_surface, std::span<PatchId> patches) const
{
    constexpr std::size_t ahead = 64;
    std::array<std::uint32_t, ahead> cells;
    for (std::size_t first = 0; first < surface.size(); first += ahead) {
        const std::size_t n = std::min(ahead, surface.size() - first);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = first + k;
            const std::uint32_t grid = surface[i] < no_surface ? surface_grid_[surface[i]] : no_grid;
            cells[k] = grid == no_grid ? no_grid : cell_index(grids_[grid], x[i], y[i]);
            if (cells[k] != no_grid) __builtin_prefetch(&cells_[cells[k]]);
        }
        for (std::size_t k = 0; k < n; ++k) {
            if (cells[k] == no_grid) continue;
            const Cell& cell = cells_[cells[k]];
            const char* entry = cell.count > 0 ? reinterpret_cast<const char*>(&entries_[cell.first])
                                               : reinterpret_cast<const char*>(&grids_[cell.first]);
            for (std::size_t line = 0; line < 3; ++line) __builtin_prefetch(entry + 64 * line);
        }
        for (std::size_t k = 0; k < n; ++k)
            patches[first + k] = cells[k] == no_grid ? PatchId() : search(cells_[cells[k]], x[first + k], y[first + k]);
    }
}

std::array<double, 3> PatchLocator::barycentric(PatchId patch, const Vec2& q) const
{
    const auto c = mesh_->corners(patch);
    const Vec2 p0 = mesh_->plane_position(c[0]), p1 = mesh_->plane_position(c[1]), p2 = mesh_->plane_position(c[2]);
    const double whole = cross2(p0, p1, p2);
    std::array<double, 3> w{std::max(0.0, cross2(q, p1, p2) / whole), std::max(0.0, cross2(p0, q, p2) / whole),
                            std::max(0.0, cross2(p0, p1, q) / whole)};
    const double sum = w[0] + w[1] + w[2];
    for (double& x : w) x /= sum;
    return w;
}

}  // namespace patchlight
