#include "solver/hit_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {

namespace {

constexpr int set_count = 32;
constexpr float parts = 65535.0F;

}  // namespace

HitRows::HitRows(const Exchange& exchange, const HitRowOptions& options)
    : exchange_(exchange), options_(options),
      sets_(hemisphere_sets({.directions = options.directions, .rays = options.rays, .seed = options.seed}, set_count))
{
    const PatchMesh& mesh = exchange.mesh;
    triangles_.reserve(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const auto c = mesh.corners(p);
        const Vec2 p0 = mesh.plane_position(c[0]), p1 = mesh.plane_position(c[1]), p2 = mesh.plane_position(c[2]);
        const double scale = 1 / cross2(p0, p1, p2);
        const auto f = [](double x) { return static_cast<float>(x); };
        triangles_.push_back({f(p2.x), f(p2.y), f((p1.y - p2.y) * scale), f((p2.x - p1.x) * scale),
                              f((p2.y - p0.y) * scale), f((p0.x - p2.x) * scale)});
    }
}

bool HitRows::reflects(const SurfacePoint& point) const
{
    return exchange_.scene.material_of(point.surface).reflects();
}

void HitRows::add(std::span<const SurfacePoint> points, const WorkMonitor& monitor)
{
    const std::size_t first = points_.size();
    points_.insert(points_.end(), points.begin(), points.end());
    kept_.resize(points_.size());
    const std::size_t row_bytes = sets_.front().size() * sizeof(Hit);
    const std::size_t room = (options_.most_bytes - std::min(bytes_, options_.most_bytes)) / row_bytes;
    const std::size_t count = std::min(points.size(), room);
    bytes_ += count * row_bytes;
    keeps_all_ = keeps_all_ && count == points.size();
    rays_ += for_each_row<Scratch>(count, monitor, [&](std::size_t i, Scratch& scratch) {
        if (reflects(points_[first + i])) trace(points_[first + i], kept_[first + i], scratch);
    });
}

void HitRows::trace(const SurfacePoint& point, std::vector<Hit>& row, Scratch& scratch) const
{
    const PlaneFrame& frame = exchange_.scene.surface(point.surface).frame;
    const PickedSet picked = pick_set(sets_.size(), options_.seed, point.surface.value);
    const HemisphereSet& set = sets_[picked.index];
    aim_from(exchange_.caster.leave(point.position, frame.n), set, frame, picked.turn, scratch.rays);
    exchange_.caster.closest(scratch.rays, scratch.hits);
    scratch.traced += set.size();
    scratch.found.resize(set.size());
    const HitBatch& hits = scratch.hits;
    exchange_.locator.locate(hits.surface, hits.x, hits.y, HitBatch::black_back, scratch.found);
    row.assign(set.size(), Hit{dark, 0, 0});
    for (std::size_t k = 0; k < set.size(); ++k) {
        if (!scratch.found[k].valid()) continue;
        const Triangle& t = triangles_[scratch.found[k].value];
        const float dx = hits.x[k] - t.x0, dy = hits.y[k] - t.y0;
        // Rounding may put a hit just outside of its patch.
        const float w0 = std::clamp(t.a0 * dx + t.b0 * dy, 0.0F, 1.0F);
        const float w1 = std::clamp(t.a1 * dx + t.b1 * dy, 0.0F, 1.0F - w0);
        row[k] = {scratch.found[k].value, static_cast<std::uint16_t>(parts * w0 + 0.5F),
                  static_cast<std::uint16_t>(parts * w1 + 0.5F)};
    }
}

namespace {

/// A quadratic function over each patch: a0 + a1 w0 + a2 w1 + a3 w0² + a4 w1² + a5 w0 w1, of each band.
using Quadratic = std::array<std::array<float, 3>, 6>;

std::vector<Quadratic> quadratics(const PatchMesh& mesh, const QuadraticRadiosity& B)
{
    std::vector<Quadratic> result(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const auto c = mesh.corners(p);
        const Rgb &x = B.at_vertices[c[0]], &y = B.at_vertices[c[1]], &z = B.at_vertices[c[2]];
        const auto& middle = B.at_middles[p];  // of xy, yz, zx
        const std::array<Rgb, 6> a{z,
                                   4.0 * middle[2] - x - 3.0 * z,
                                   4.0 * middle[1] - y - 3.0 * z,
                                   2.0 * (x + z - 2.0 * middle[2]),
                                   2.0 * (y + z - 2.0 * middle[1]),
                                   4.0 * (z + middle[0] - middle[1] - middle[2])};
        for (std::size_t k = 0; k < 6; ++k)
            for (int band = 0; band < 3; ++band)
                result[p.value][k][static_cast<std::size_t>(band)] = static_cast<float>(a[k][band]);
    }
    return result;
}

}  // namespace

std::vector<Rgb> HitRows::irradiance(std::span<const std::uint32_t> points, const QuadraticRadiosity& leaving,
                                     const WorkMonitor& monitor)
{
    const std::vector<Quadratic> light = quadratics(exchange_.mesh, leaving);
    std::vector<Rgb> H(points.size(), Rgb(0.0));
    rays_ += for_each_row<Scratch>(points.size(), monitor, [&](std::size_t i, Scratch& scratch) {
        const SurfacePoint& point = points_[points[i]];
        if (!reflects(point)) return;
        const std::vector<Hit>* row = &kept_[points[i]];
        if (row->empty()) {
            trace(point, scratch.row, scratch);
            row = &scratch.row;
        }
        const HemisphereSet& set = sets_[pick_set(sets_.size(), options_.seed, point.surface.value).index];
        Rgb sum(0.0);
        for (std::size_t k = 0; k < row->size(); ++k) {
            const Hit& hit = (*row)[k];
            if (hit.patch == dark) continue;
            const Quadratic& a = light[hit.patch];
            const float w0 = static_cast<float>(hit.w0) / parts, w1 = static_cast<float>(hit.w1) / parts;
            for (std::size_t band = 0; band < 3; ++band) {
                const float B = a[0][band] + w0 * (a[1][band] + w0 * a[3][band] + w1 * a[5][band]) +
                                w1 * (a[2][band] + w1 * a[4][band]);
                sum[static_cast<int>(band)] += static_cast<double>(set.factor[k] * B);
            }
        }
        H[i] = glm::max(sum, Rgb(0.0));
    });
    return H;
}

}  // namespace patchlight
