#include "formfactor/source.h"

#include "formfactor/lambert.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

// Short of the source, relative to the ray: the source's own surface must not hide it.
constexpr float nearly_there = 1 - 1e-5F;

}  // namespace

Source::Source(const Scene& scene, SurfaceId surface) : Source(scene, surface, facets_of(scene, surface)) {}

Source::Source(const Scene& scene, SurfaceId surface, std::span<const Facet> facets)
    : surface_(surface), normal_(scene.surface(surface).frame.n)
{
    for (const Facet& facet : facets) pieces_.push_back(facet.corners);
    if (pieces_.size() == 1 && pieces_[0].size() == 4) {
        const std::vector<Vec3>& outer = pieces_[0];
        const Vec3 gap = outer[0] + outer[2] - outer[1] - outer[3];
        parallelogram_ = glm::dot(gap, gap) <= 1e-20 * glm::dot(outer[2] - outer[0], outer[2] - outer[0]);
    }
    divide();
}

Source::Source(SurfaceId surface, const Vec3& normal, std::span<const std::array<Vec3, 3>> triangles)
    : surface_(surface), normal_(normal)
{
    for (const auto& t : triangles) pieces_.push_back({t[0], t[1], t[2]});
    divide();
}

/// Cuts the pieces into triangles, with the share of the area up to each.
void Source::divide()
{
    double area = 0;
    for (const auto& piece : pieces_)
        for (std::size_t k = 2; k < piece.size(); ++k) {
            Triangle t{piece[0], piece[k - 1] - piece[0], piece[k] - piece[0], 0};
            area += 0.5 * glm::length(glm::cross(t.edge0, t.edge1));
            t.until = area;
            triangles_.push_back(t);
        }
    for (Triangle& t : triangles_) t.until /= area;
}

double Source::unoccluded(const Vec3& p, const Vec3& n) const
{
    double sum = 0;
    for (const auto& piece : pieces_) sum += lambert_factor(p, n, piece);
    return sum;
}

Vec3 Source::point(double u, double v) const
{
    if (parallelogram_)
        return pieces_[0][0] + u * (pieces_[0][1] - pieces_[0][0]) + v * (pieces_[0][3] - pieces_[0][0]);
    const auto found =
        std::find_if(triangles_.begin(), triangles_.end() - 1, [&](const Triangle& t) { return u < t.until; });
    const double from = found == triangles_.begin() ? 0 : std::prev(found)->until;
    const double within = std::clamp((u - from) / (found->until - from), 0.0, 1.0);
    const double root = std::sqrt(within);
    return found->corner + root * (1 - v) * found->edge0 + root * v * found->edge1;
}

namespace {

/// One shadow ray into each of side × side strata; returns the sums of all weights and of the visible ones.
std::pair<double, double> trace_strata(const RayCaster& caster, const Source& source,
                                       std::span<const ReceiverPoint> receivers, int side, RandomNumbers& random,
                                       ShadowScratch& scratch)
{
    const auto n = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    scratch.rays.resize(n);
    scratch.weights.clear();
    scratch.visible.clear();
    double all = 0;
    std::size_t traced = 0;
    // 2 × 4 tiles where they fit would gain little: rows of strata are coherent enough.
    for (std::size_t k = 0; k < n; ++k) {
        const double u = (static_cast<double>(k % static_cast<std::size_t>(side)) + random.uniform()) / side;
        const double v = (static_cast<double>(k / static_cast<std::size_t>(side)) + random.uniform()) / side;
        const ReceiverPoint& receiver = receivers[k % receivers.size()];
        const Vec3 target = source.point(u, v);
        const Vec3 from = caster.leave(receiver.position, receiver.normal);
        const Vec3 d = target - from;
        const double r2 = glm::dot(d, d);
        const double weight = -glm::dot(d, receiver.normal) * glm::dot(d, source.normal()) / (r2 * r2);
        if (!(weight > 0) || glm::dot(d, receiver.normal) <= 0) continue;
        scratch.rays.set(traced++, from, d, nearly_there);
        scratch.weights.push_back(weight);
        scratch.visible.push_back({target, weight});
        all += weight;
    }
    scratch.rays.resize(traced);
    caster.occluded(scratch.rays, scratch.blocked);
    scratch.traced += traced;
    double seen = 0;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < traced; ++k)
        if (scratch.blocked[k] == 0) {
            seen += scratch.weights[k];
            scratch.visible[kept++] = scratch.visible[k];
        }
    scratch.visible.resize(kept);
    return {all, seen};
}

}  // namespace

double visible_factor(const RayCaster& caster, const Source& source, std::span<const ReceiverPoint> receivers, int rays,
                      RandomNumbers& random, ShadowScratch& scratch)
{
    double whole = 0;
    for (const ReceiverPoint& receiver : receivers) whole += source.unoccluded(receiver.position, receiver.normal);
    whole /= static_cast<double>(receivers.size());
    scratch.visible.clear();
    if (!(whole > 0)) return 0;

    const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(rays))));
    const int first_side = std::max(4, side / 4);
    const bool look_first = receivers.size() == 1 && first_side < side;
    auto [all, seen] = trace_strata(caster, source, receivers, look_first ? first_side : side, random, scratch);
    if (look_first && seen > 0 && seen < all)
        std::tie(all, seen) = trace_strata(caster, source, receivers, side, random, scratch);
    if (!(all > 0)) return 0;
    for (VisibleSample& sample : scratch.visible) sample.weight *= whole / all;
    return whole * (seen / all);
}

}  // namespace patchlight
