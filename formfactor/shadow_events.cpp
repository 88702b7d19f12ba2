#include "formfactor/shadow_events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace patchlight {

namespace {

/// Beyond this many pairs of blockers' edges and corners their own events are left out: adaptivity has to do.
constexpr std::size_t most_blocker_events = 2000;

using Segment = std::array<Vec3, 2>;

const auto by_place = [](const Vec3& p, const Vec3& q) { return precedes(p, q); };

/// Corners and edges of several polygons, each once.
struct Skeleton {
    std::vector<Vec3> corners;
    std::vector<Segment> edges;

    void add(std::span<const Vec3> polygon)
    {
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
            corners.push_back(p);
            edges.push_back(precedes(p, q) ? Segment{p, q} : Segment{q, p});
        }
    }
    void make_unique()
    {
        std::ranges::sort(corners, by_place);
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        std::ranges::sort(edges, [](const Segment& a, const Segment& b) {
            return a[0] != b[0] ? precedes(a[0], b[0]) : precedes(a[1], b[1]);
        });
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
};

/// Which points of the plane through a corner and an edge belong: those opposite to the edge, or beyond it, or both.
enum class Reach { opposite, beyond, both };

class EventFinder {
public:
    EventFinder(const OuterPlane& plane, std::span<const Vec2> outer) : plane_(plane), outer_(outer)
    {
        Vec2 low = outer[0], high = outer[0];
        for (const Vec2& q : outer) {
            low = glm::min(low, q);
            high = glm::max(high, q);
        }
        least_ = 1e-12 * glm::length(high - low);
    }

    void add(const Vec3& corner, const Segment& edge, Reach reach)
    {
        const Vec3 p = edge[0] - corner, q = edge[1] - corner, normal = glm::cross(p, q);
        const double square = glm::dot(normal, normal);
        if (!(square > 1e-28 * glm::dot(p, p) * glm::dot(q, q))) return;
        ShadowEvent event;
        if (!chord(normal, corner, event)) return;
        // x − corner = α p + β q with both ≥ 0 beyond the edge, both ≤ 0 opposite to it.
        const auto weights = [&](const Vec2& at) {
            const Vec3 x = plane_.lift(at) - corner;
            return std::pair(glm::dot(glm::cross(x, q), normal) / square, glm::dot(glm::cross(p, x), normal) / square);
        };
        const auto [a0, b0] = weights(event.start);
        const auto [a1, b1] = weights(event.end);
        if (reach != Reach::opposite) keep(event, {a0, a1}, {b0, b1});
        if (reach != Reach::beyond) keep(event, {-a0, -a1}, {-b0, -b1});
    }

    void add_plane(const Blocker& blocker)
    {
        ShadowEvent event;
        if (chord(blocker.normal, blocker.corners[0], event)) found.push_back(event);
    }

    std::vector<ShadowEvent> found;

private:
    /// The part of a plane's line that crosses the outer polygon.
    bool chord(const Vec3& normal, const Vec3& through, ShadowEvent& event) const
    {
        const Vec2 n(glm::dot(normal, plane_.u), glm::dot(normal, plane_.v));
        const double length = glm::length(n);
        if (!(length > 1e-14 * glm::length(normal))) return false;
        event.normal = n / length;
        event.offset = glm::dot(normal, through - plane_.origin) / length;
        int ends = 0;
        for (std::size_t i = 0; i < outer_.size(); ++i) {
            const Vec2 &p = outer_[i], &q = outer_[(i + 1) % outer_.size()];
            const double hp = glm::dot(event.normal, p) - event.offset, hq = glm::dot(event.normal, q) - event.offset;
            if ((hp < 0) == (hq < 0)) continue;
            const Vec2 at = p + (hp / (hp - hq)) * (q - p);
            (ends++ == 0 ? event.start : event.end) = at;
        }
        return ends == 2 && glm::length(event.end - event.start) > least_;
    }

    /// Cuts the chord to where both weights, linear along it, are ≥ 0.
    void keep(const ShadowEvent& event, const std::array<double, 2>& alpha, const std::array<double, 2>& beta)
    {
        double from = 0, to = 1;
        for (const auto& [w0, w1] : {alpha, beta}) {
            if (w0 < 0 && w1 < 0) return;
            if (w0 < 0) from = std::max(from, w0 / (w0 - w1));
            if (w1 < 0) to = std::min(to, w0 / (w0 - w1));
        }
        if (!(to > from)) return;
        ShadowEvent part = event;
        part.start = event.start + from * (event.end - event.start);
        part.end = event.start + to * (event.end - event.start);
        if (glm::length(part.end - part.start) > least_) found.push_back(part);
    }

    const OuterPlane& plane_;
    std::span<const Vec2> outer_;
    double least_ = 0;  ///< shorter chords are rounding
};

}  // namespace

std::vector<ShadowEvent> shadow_events(const OuterPlane& plane, std::span<const Vec2> outer,
                                       std::span<const Vec3> target, std::span<const Blocker> blockers)
{
    Skeleton aim, way;
    aim.add(target);
    for (const Blocker& blocker : blockers) way.add(blocker.corners);
    way.make_unique();
    EventFinder finder(plane, outer);
    for (const Vec3& corner : aim.corners)
        for (const Segment& edge : way.edges) finder.add(corner, edge, Reach::beyond);
    for (const Vec3& corner : way.corners)
        for (const Segment& edge : aim.edges) finder.add(corner, edge, Reach::opposite);
    for (const Blocker& blocker : blockers) finder.add_plane(blocker);
    if (blockers.size() > 1 && way.corners.size() * way.edges.size() <= most_blocker_events)
        for (const Vec3& corner : way.corners)
            for (const Segment& edge : way.edges) finder.add(corner, edge, Reach::both);
    return std::move(finder.found);
}

}  // namespace patchlight
