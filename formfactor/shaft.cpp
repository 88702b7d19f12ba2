#include "formfactor/shaft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patchlight {

namespace {

struct Extent {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void add(std::span<const Vec3> points, const Vec3& axis)
    {
        for (const Vec3& p : points) {
            const double t = glm::dot(p, axis);
            least = std::min(least, t);
            most = std::max(most, t);
        }
    }
};

Vec3 mean(std::span<const Vec3> points)
{
    Vec3 sum(0.0);
    for (const Vec3& p : points) sum += p;
    return sum / static_cast<double>(points.size());
}

const Vec3& farthest(std::span<const Vec3> points, const Vec3& axis, double& reach)
{
    const Vec3* best = &points.front();
    reach = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : points)
        if (const double t = glm::dot(p, axis); t > reach) {
            reach = t;
            best = &p;
        }
    return *best;
}

/// The axis is turned away from what overlaps until the blocker lies beyond the shaft, or the steps are used up.
bool direction_found(const Shaft& shaft, const BlockerView& blocker, double snap)
{
    constexpr int steps = 8;
    const Vec3 centre = mean(blocker.corners), start = mean(shaft.a), along = mean(shaft.b) - start;
    const double t = std::clamp(glm::dot(centre - start, along) / glm::dot(along, along), 0.0, 1.0);
    Vec3 axis = centre - start - t * along;
    double length = glm::length(axis);
    if (!(length > snap)) return false;
    axis /= length;
    for (int step = 0; step < steps; ++step) {
        double reach_a = 0, reach_b = 0, back = 0;
        const Vec3& pa = farthest(shaft.a, axis, reach_a);
        const Vec3& pb = farthest(shaft.b, axis, reach_b);
        const Vec3& near = farthest(blocker.corners, -axis, back);
        if (-back >= std::max(reach_a, reach_b) - snap) return true;
        const Vec3 overlap = near - (reach_a > reach_b ? pa : pb);
        length = glm::length(overlap);
        if (!(length > 0)) return false;
        const Vec3 r = overlap / length;
        axis -= 2 * glm::dot(axis, r) * r;
    }
    return false;
}

/// Whether a side plane of the shaft, through an edge of one end and a corner of the other, has the blocker outside.
bool beyond_side(std::span<const Vec3> edges, std::span<const Vec3> corners, const BlockerView& blocker, double snap)
{
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Vec3 &p = edges[i], along = edges[(i + 1) % edges.size()] - p;
        for (const Vec3& q : corners) {
            const Vec3 normal = glm::cross(along, q - p);
            const double length = glm::length(normal), offset = glm::dot(normal, p), slack = snap * length;
            if (!(length > 0)) continue;
            Extent ends;
            ends.add(edges, normal);
            ends.add(corners, normal);
            const bool below = ends.most <= offset + slack, above = ends.least >= offset - slack;
            if (!below && !above) continue;
            Extent inside;
            inside.add(blocker.corners, normal);
            if ((below && inside.least >= offset - slack) || (above && inside.most <= offset + slack)) return true;
        }
    }
    return false;
}

/// For a blocker whose plane parts `from` (in its front) from `to`: by the sides of its edges.
Visibility past_edges(std::span<const Vec3> from, std::span<const Vec3> to, const BlockerView& blocker, double snap)
{
    // Seen from the front the corners run counter-clockwise; the volume is positive where a line passes outside.
    const std::size_t n = blocker.corners.size();
    bool covered = true;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 &e0 = blocker.corners[k], &e1 = blocker.corners[k + 1 < n ? k + 1 : 0];
        bool outside = true;
        for (const Vec3& x : from) {
            const Vec3 normal = glm::cross(e0 - x, e1 - x);
            const double slack = snap * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
            for (const Vec3& y : to) {
                const double volume = glm::dot(normal, y - x);
                outside = outside && volume >= -slack;
                covered = covered && volume <= 0;
            }
        }
        if (outside) return Visibility::visible;
    }
    return covered ? Visibility::hidden : Visibility::partial;
}

}  // namespace

Visibility visibility_past(const Shaft& shaft, const BlockerView& blocker, double snap)
{
    Extent a, b;
    a.add(shaft.a, blocker.normal);
    b.add(shaft.b, blocker.normal);
    if (std::min(a.least, b.least) >= blocker.offset - snap || std::max(a.most, b.most) <= blocker.offset + snap)
        return Visibility::visible;
    if (a.least >= blocker.offset && b.most <= blocker.offset) return past_edges(shaft.a, shaft.b, blocker, snap);
    if (b.least >= blocker.offset && a.most <= blocker.offset) return past_edges(shaft.b, shaft.a, blocker, snap);
    const bool apart = direction_found(shaft, blocker, snap) || beyond_side(shaft.a, shaft.b, blocker, snap) ||
                       beyond_side(shaft.b, shaft.a, blocker, snap);
    return apart ? Visibility::visible : Visibility::partial;
}

}  // namespace patchlight
