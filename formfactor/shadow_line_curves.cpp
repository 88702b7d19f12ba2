#include "formfactor/shadow_line_finder.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace patchlight {

namespace {

constexpr int samples = 8;                ///< parts of an interval at whose ends rays are cast
constexpr double least_interval = 1e-10;  ///< of a curve's parameter: where what is met changes
constexpr double inset = 1e-6;            ///< of an interval: at its very ends rays pass corners

using Segment = std::array<Vec3, 2>;

Vec3 between(const Segment& s, double t)
{
    return (1 - t) * s[0] + t * s[1];
}

/// Six times the volume of a segment's tetrahedron with another one.
double volume(const Vec3& p, const Segment& s, const Vec3& q)
{
    return glm::dot(glm::cross(s[0] - p, s[1] - p), q - p);
}

}  // namespace

/// All lines that meet three segments, by the place t on the first. Where one meets another is a ratio of linear
/// functions of t.
class ShadowLineFinder::Regulus {
public:
    Regulus(const Segment& source, const Segment& near, const Segment& far) : edges_{source, near, far}
    {
        for (std::size_t k = 0; k < 2; ++k)
            for (std::size_t end = 0; end < 2; ++end) {
                on_far_[k][end] = volume(source[end], near, far[k]);
                on_near_[k][end] = volume(source[end], far, near[k]);
            }
    }

    Ray ray(double t) const
    {
        const auto place = [&](const Ends& heights) {
            const double h0 = height(heights[0], t), h1 = height(heights[1], t);
            return h0 / (h0 - h1);
        };
        return {between(edges_[0], t),
                {between(edges_[1], place(on_near_)), between(edges_[2], place(on_far_))},
                {edges_[1][1] - edges_[1][0], edges_[2][1] - edges_[2][0]}};
    }

    /// Where the line meets the second edge and then the third.
    std::vector<Span> intervals() const
    {
        std::vector<double> stops{0, 1};
        for (const Ends& ends : {on_near_, on_far_})
            for (const auto& h : ends)
                if (h[0] * h[1] < 0) stops.push_back(h[0] / (h[0] - h[1]));
        std::ranges::sort(stops);
        std::vector<Span> result;
        for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
            const Span part{stops[k], stops[k + 1]};
            if (part.to - part.from <= least_interval || !meets(0.5 * (part.from + part.to))) continue;
            if (!result.empty() && result.back().to == part.from)
                result.back().to = part.to;
            else
                result.push_back(part);
        }
        return result;
    }

private:
    using Ends = std::array<std::array<double, 2>, 2>;

    static double height(const std::array<double, 2>& h, double t) { return (1 - t) * h[0] + t * h[1]; }
    bool meets(double t) const
    {
        for (const Ends& ends : {on_near_, on_far_})
            if (!(height(ends[0], t) * height(ends[1], t) < 0)) return false;
        const Ray r = ray(t);
        const Vec3 d = r.past[1] - r.from;
        const double s = glm::dot(r.past[0] - r.from, d);
        return s > 0 && s < glm::dot(d, d);
    }

    std::array<Segment, 3> edges_;
    Ends on_near_{}, on_far_{};  ///< heights of the edge's ends over the plane through the other, for both ends of t
};

/// Whether a facet has a point; `inside`: not on its rim.
bool ShadowLineFinder::has(const Facet& facet, const Vec3& p, double slack, bool& inside) const
{
    inside = true;
    const std::size_t n = facet.corners.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 along = facet.corners[(k + 1) % n] - facet.corners[k];
        const double h = glm::dot(glm::cross(facet.normal, along), p - facet.corners[k]);
        const double margin = slack * glm::length(along);
        if (h < -margin) return false;
        inside = inside && h > margin;
    }
    return true;
}

/// The half-spaces around a ray's line, then what is beyond its start and before `until` along it.
std::array<FacetTree::HalfSpace, 6> ShadowLineFinder::around(const Vec3& from, const Vec3& d, double until) const
{
    const Vec3 other = std::abs(d.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 u = glm::normalize(glm::cross(d, other)), v = glm::cross(d, u);
    const double margin = 4 * snap_;
    std::array<FacetTree::HalfSpace, 6> region;
    const std::array<Vec3, 5> axes{u, -u, v, -v, d};
    for (std::size_t k = 0; k < 5; ++k) region[k] = {axes[k], glm::dot(axes[k], from) - margin};
    region[5] = {-d, -(glm::dot(d, from) + until + margin)};
    return region;
}

/// Whether nothing hides a ray up to the second edge. What stands on an edge hides it when it does on both sides.
bool ShadowLineFinder::passes(const Ray& ray) const
{
    const Vec3 d = glm::normalize(ray.past[1] - ray.from);
    const double until = glm::dot(d, ray.past[1] - ray.from);
    const double slack = 2 * snap_;
    std::array<Vec3, 2> across;
    for (std::size_t k = 0; k < 2; ++k) across[k] = glm::normalize(glm::cross(ray.along[k], d));
    std::array<unsigned, 2> sides{0, 0};
    bool free = true;
    tree_.visit(around(ray.from, d, until), [&](std::uint32_t f) {
        const Facet& facet = facets_[f];
        const auto height = [&](const Vec3& p) { return glm::dot(facet.normal, p - facet.corners[0]); };
        bool inside = false, touches = false;
        for (std::size_t k = 0; k < 2; ++k) {
            if (std::abs(height(ray.past[k])) > slack || !has(facet, ray.past[k], slack, inside)) continue;
            touches = true;
            for (const Vec3& p : facet.corners) {
                const double h = glm::dot(across[k], p - ray.past[k]);
                sides[k] |= h > slack ? 1U : h < -slack ? 2U : 0U;
            }
        }
        const double from = height(ray.from), to = height(ray.past[1]);
        if (!touches && std::abs(from) > slack && std::abs(to) > slack && (from < 0) != (to < 0)) {
            const Vec3 at = ray.from + from / (from - to) * (ray.past[1] - ray.from);
            if (has(facet, at, slack, inside) && inside) free = false;
        }
        if (sides[0] == 3 || sides[1] == 3) free = false;
        return free;
    });
    return free;
}

/// The facet whose front a ray meets first beyond the second edge: none where that doesn't reflect.
std::optional<std::uint32_t> ShadowLineFinder::receiver(const Ray& ray) const
{
    const Vec3 d = glm::normalize(ray.past[1] - ray.from);
    const double slack = 2 * snap_;
    double nearest = 2 * scene_.diameter;
    std::optional<std::uint32_t> met;
    bool fronts = false;
    std::array<FacetTree::HalfSpace, 6> region = around(ray.past[1], d, nearest);
    tree_.visit(region, [&](std::uint32_t f) {
        const Facet& facet = facets_[f];
        const double h = glm::dot(facet.normal, ray.past[1] - facet.corners[0]), fall = glm::dot(facet.normal, d);
        if (std::abs(h) <= slack || (h < 0) == (fall < 0)) return true;
        const double distance = -h / fall;
        bool inside = false;
        if (!(distance < nearest + slack) || !has(facet, ray.past[1] + distance * d, slack, inside)) return true;
        // Of two back to back, or of the same place, the one that is seen and reflects.
        const bool front = h > 0 && scene_.material_of(facet.surface).reflects();
        if (met && std::abs(distance - nearest) <= slack && (front != fronts ? fronts : *met < f)) return true;
        met = f;
        fronts = front;
        nearest = distance;
        region[5].offset = -(glm::dot(d, ray.past[1]) + nearest + 4 * snap_);
        return true;
    });
    return fronts ? met : std::nullopt;
}

std::optional<SurfaceId> ShadowLineFinder::met_by(const Ray& ray) const
{
    if (!passes(ray)) return std::nullopt;
    const auto facet = receiver(ray);
    return facet ? std::optional(facets_[*facet].surface) : std::nullopt;
}

/// Adds the place between two at which what a curve's rays meet changes.
void ShadowLineFinder::add_changes(const Regulus& regulus, const Met& a, const Met& b, std::vector<Met>& changes) const
{
    if (a.surface == b.surface) return;
    const double middle = 0.5 * (a.t + b.t);
    if (b.t - a.t <= least_interval) {
        changes.push_back({middle, b.surface});
        return;
    }
    const Met m{middle, met_by(regulus.ray(middle))};
    add_changes(regulus, a, m, changes);
    add_changes(regulus, m, b, changes);
}

/// A curve on a plane as straight pieces within the tolerance. At quarters, since the middle of t may lie aside.
void ShadowLineFinder::add_arc(const Regulus& regulus, SurfaceId surface, Span part, int depth, Lines& lines) const
{
    const PlaneFrame& frame = scene_.surface(surface).frame;
    const auto place = [&](double f) {
        const Ray ray = regulus.ray(part.from + f * (part.to - part.from));
        const Vec3 d = ray.past[1] - ray.from;
        return frame.to_plane(ray.from + glm::dot(frame.n, frame.origin - ray.from) / glm::dot(frame.n, d) * d);
    };
    const SurfaceLine line{surface, LineKind::eee, place(0), place(1)};
    const double length = glm::length(line.end - line.start);
    const bool straight = std::ranges::all_of(std::array{0.25, 0.5, 0.75}, [&](double f) {
        const Vec2 q = place(f);
        return std::abs(cross2(line.start, line.end, q)) <= options_.eee_tolerance * scene_.diameter * length;
    });
    if (!std::isfinite(length)) return;
    if (straight || depth == 0) {
        if (length > snap_) lines.push_back(line);
        return;
    }
    const double middle = 0.5 * (part.from + part.to);
    add_arc(regulus, surface, {part.from, middle}, depth - 1, lines);
    add_arc(regulus, surface, {middle, part.to}, depth - 1, lines);
}

/// Where an edge of the source is seen against two skew ones, `near` before `far`.
void ShadowLineFinder::past_skew_edges(const Source& source, const Segment& edge, const Segment& near,
                                       const Segment& far, Lines& lines) const
{
    if (!skew(edge, near) || !skew(edge, far)) return;
    const Regulus regulus(edge, near, far);
    for (const Span& whole : regulus.intervals()) {
        const double width = whole.to - whole.from;
        std::vector<Met> places;
        for (int k = 0; k <= samples; ++k) {
            const double f = std::clamp(k / double(samples), inset, 1 - inset);
            const double t = whole.from + f * width;
            places.push_back({t, met_by(regulus.ray(t))});
        }
        std::vector<Met> changes{{whole.from, places[0].surface}};
        for (std::size_t k = 0; k + 1 < places.size(); ++k) add_changes(regulus, places[k], places[k + 1], changes);
        for (std::size_t k = 0; k < changes.size(); ++k) {
            const Span part{changes[k].t, k + 1 < changes.size() ? changes[k + 1].t : whole.to};
            if (changes[k].surface && *changes[k].surface != source.surface)
                add_arc(regulus, *changes[k].surface, part, 12, lines);
        }
    }
}

/// The part of an edge in front of a source's plane.
std::optional<ShadowLineFinder::Segment> ShadowLineFinder::in_front(const Source& source, const Edge& edge) const
{
    Segment result{at(edge[0]), at(edge[1])};
    const double h0 = above(source, result[0]), h1 = above(source, result[1]);
    if (h0 <= 0 && h1 <= 0) return std::nullopt;
    if (h0 < 0 || h1 < 0) result[h0 < 0 ? 0 : 1] = between(result, h0 / (h0 - h1));
    return result;
}

/// Pairs of skew edges past both of which the source's light may go, the closest first.
std::vector<ShadowLineFinder::EdgePair> ShadowLineFinder::skew_pairs(const Source& source,
                                                                     const std::vector<bool>& lit) const
{
    std::vector<std::vector<EdgePair>> of_edge(edges_.size());
    tbb::parallel_for(std::size_t{0}, edges_.size(), [&](std::size_t e) {
        const auto near = in_front(source, edges_[e]);
        if (!lit[e] || !near) return;
        edge_tree_.visit(shadow_of(source, *near), [&](std::uint32_t f) {
            const Segment far{at(edges_[f][0]), at(edges_[f][1])};
            if (!lit[f] || !skew(*near, far)) return true;
            const Vec3 gap = (far[0] + far[1]) - ((*near)[0] + (*near)[1]);
            of_edge[e].push_back({glm::dot(gap, gap), static_cast<std::uint32_t>(e), f});
            return true;
        });
    });
    std::vector<EdgePair> pairs;
    for (const auto& some : of_edge) pairs.insert(pairs.end(), some.begin(), some.end());
    // Of pairs equally far apart the one that comes first in space: the order of surfaces doesn't matter.
    const auto precedes = [&](const EdgePair& a, const EdgePair& b) {
        const auto key = [&](const EdgePair& p) {
            const Vec3 n = at(edges_[p.near][0]) + at(edges_[p.near][1]);
            const Vec3 f = at(edges_[p.far][0]) + at(edges_[p.far][1]);
            return std::tuple(p.distance, n.x, n.y, n.z, f.x, f.y, f.z);
        };
        return key(a) < key(b);
    };
    if (pairs.size() > options_.most_eee_pairs) {
        std::ranges::sort(pairs, precedes);
        pairs.resize(options_.most_eee_pairs);
    }
    return pairs;
}

/// All curves of a source; `lit`: the edges past which its corners' light arrives somewhere.
void ShadowLineFinder::add_curves(const Source& source, const std::vector<bool>& lit, Lines& lines) const
{
    const std::vector<EdgePair> pairs = skew_pairs(source, lit);
    std::vector<Lines> found(pairs.size());
    tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
        const auto near = in_front(source, edges_[pairs[k].near]);
        const Segment far{at(edges_[pairs[k].far][0]), at(edges_[pairs[k].far][1])};
        if (!near) return;
        for (const Edge& e : source.edges) past_skew_edges(source, {at(e[0]), at(e[1])}, *near, far, found[k]);
    });
    for (const Lines& some : found) lines.insert(lines.end(), some.begin(), some.end());
}

}  // namespace patchlight
