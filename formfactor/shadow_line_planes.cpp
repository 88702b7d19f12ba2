#include "formfactor/shadow_line_finder.h"

#include <algorithm>

namespace patchlight {

namespace {

/// Of the plane through a and that end of b which is further off a's line.
Vec3 normal_of(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b)
{
    const Vec3 p = glm::cross(a[1] - a[0], b[0] - a[0]), q = glm::cross(a[1] - a[0], b[1] - a[0]);
    return glm::dot(p, p) > glm::dot(q, q) ? p : q;
}

}  // namespace

/// Where the source's own plane meets others, as far as its corners see it.
void ShadowLineFinder::source_plane(const Source& source, const Vec3& apex, Work& work, Lines& lines) const
{
    const PlaneFrame& frame = scene_.surface(source.surface).frame;
    const std::array around{frame.u, frame.v, -frame.u, -frame.v};
    for (std::size_t k = 0; k < 4; ++k) {
        const Segment base{apex + scene_.diameter * around[k], apex + scene_.diameter * around[(k + 1) % 4]};
        const Pencil pencil(tree_, facets_, apex, base, snap_);
        ++work.counts.pencils;
        pencil.outward({0, 1}, work.pencil);
        add_hits(pencil, apex, LineKind::plane, work, lines);
    }
}

/// Where a surface is seen edge on from the source, in front of others: past its edges from both ends of the segment in
/// which its plane cuts the source, and past its corners from in between.
void ShadowLineFinder::surface_plane(const Source& source, SurfaceId id, Work& work, Lines& lines) const
{
    const Surface& surface = scene_.surface(id);
    if (id == source.surface) return;
    if (std::ranges::none_of(surface.loops[0], [&](std::uint32_t v) { return above(source, at(v)) > 0; })) return;
    for (const Segment& chord : chords(source, surface.frame.n, surface.frame.origin)) {
        for (const Edge& e : edges_of(surface))
            for (const Vec3& end : along(chord))
                past_edge(source, end, {at(e[0]), at(e[1])}, LineKind::plane, work, lines);
        for (const auto& loop : surface.loops)
            for (const std::uint32_t v : loop) past_corner(source, v, chord, LineKind::plane, work, lines);
    }
}

/// In which a plane cuts the source: one of its edges, too, where that lies in the plane.
std::vector<ShadowLineFinder::Segment> ShadowLineFinder::chords(const Source& source, const Vec3& normal,
                                                                const Vec3& through) const
{
    std::vector<Segment> result;
    for (const Facet& facet : source.facets) {
        std::vector<Vec3> ends;
        const auto height = [&](const Vec3& p) {
            const double h = glm::dot(normal, p - through);
            return std::abs(h) <= snap_ ? 0.0 : h;
        };
        Vec3 last = facet.corners.back();
        for (const Vec3& p : facet.corners) {
            const double h0 = height(last), h1 = height(p);
            if (h1 == 0) ends.push_back(p);
            if (h0 * h1 < 0) ends.push_back(last + (h0 / (h0 - h1)) * (p - last));
            last = p;
        }
        if (ends.size() == 2) result.push_back({ends[0], ends[1]});
    }
    return result;
}

/// Whether two segments lie in one plane, but not in one line.
bool ShadowLineFinder::in_one_plane(const Segment& a, const Segment& b) const
{
    const Vec3 n = normal_of(a, b);
    const double length = glm::length(n);
    if (!(length > snap_ * glm::length(a[1] - a[0]))) return false;
    const double slack = snap_ * length;
    return std::abs(glm::dot(n, b[0] - a[0])) <= slack && std::abs(glm::dot(n, b[1] - a[0])) <= slack;
}

/// Whether two segments lie neither in one plane nor in one line.
bool ShadowLineFinder::skew(const Segment& a, const Segment& b) const
{
    return glm::length(normal_of(a, b)) > snap_ * glm::length(a[1] - a[0]) && !in_one_plane(a, b);
}

/// Around the shadow that an edge throws: behind it, and on the other side of planes with the source on one side. The
/// edge is in front of the source.
std::vector<FacetTree::HalfSpace> ShadowLineFinder::shadow_of(const Source& source, const Segment& e) const
{
    const double h0 = above(source, e[0]), h1 = above(source, e[1]);
    std::vector<FacetTree::HalfSpace> shadow{{source.normal, source.offset + std::min(h0, h1)}};
    const auto add = [&](Vec3 n, const Vec3& on, const Vec3& other) {
        double least = 0, most = 0;
        for (const std::uint32_t c : source.corners) {
            least = std::min(least, glm::dot(n, at(c) - on));
            most = std::max(most, glm::dot(n, at(c) - on));
        }
        const double slack = snap_ * glm::length(n);
        if (most <= slack) n = -n;
        if ((most > slack && least < -slack) || glm::dot(n, other - on) > slack) return;
        shadow.push_back({-n, glm::dot(-n, on) - slack});
    };
    for (const std::uint32_t c : source.corners) add(glm::cross(e[1] - e[0], at(c) - e[0]), e[0], e[1]);
    for (const Edge& s : source.edges) {
        add(glm::cross(at(s[0]) - e[0], at(s[1]) - e[0]), e[0], e[1]);
        add(glm::cross(at(s[0]) - e[1], at(s[1]) - e[1]), e[1], e[0]);
    }
    return shadow;
}

/// Where an edge is seen from the source to pass another of the same plane, which stands behind it, all along: a slit
/// between them closes, or one takes over from the other.
void ShadowLineFinder::past_edges_of_one_plane(const Source& source, std::uint32_t edge, Work& work, Lines& lines) const
{
    const Segment e{at(edges_[edge][0]), at(edges_[edge][1])};
    const double h0 = above(source, e[0]), h1 = above(source, e[1]);
    if (h0 < 0 || h1 < 0 || (h0 == 0 && h1 == 0)) return;
    edge_tree_.visit(shadow_of(source, e), [&](std::uint32_t f) {
        const Edge &a = edges_[edge], &b = edges_[f];
        if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return true;
        const Segment other{at(b[0]), at(b[1])};
        if (in_one_plane(e, other)) past_two_edges(source, edge, f, glm::normalize(normal_of(e, other)), work, lines);
        return true;
    });
}

/// Rays of one plane from the source past two edges: those from the ends of the source's segment in the plane, and
/// those past the edges' ends. What stands on the edges, on either side of the plane, is what makes the line: it hides
/// nothing.
void ShadowLineFinder::past_two_edges(const Source& source, std::uint32_t near, std::uint32_t far, const Vec3& normal,
                                      Work& work, Lines& lines) const
{
    const std::array<Segment, 2> both{Segment{at(edges_[near][0]), at(edges_[near][1])},
                                      Segment{at(edges_[far][0]), at(edges_[far][1])}};
    const std::vector<Segment> sources = chords(source, normal, both[0][0]);
    if (sources.empty()) return;
    for (const Segment& chord : sources)
        for (const Vec3& apex : along(chord)) {
            Pencil pencil(tree_, facets_, apex, both[1], snap_);
            if (!pencil.valid()) continue;
            ++work.counts.pencils;
            pencil.leave_open(both);
            const Span window = pencil.window_through(both[0]);
            if (!(window.to > window.from)) continue;
            pencil.beyond(window, work.pencil);
            add_hits(pencil, apex, LineKind::plane, work, lines);
        }
    for (const std::size_t k : {0U, 1U})
        for (const std::uint32_t v : edges_[k == 0 ? near : far]) {
            if (above(source, at(v)) <= 0) continue;
            Pencil pencil(tree_, facets_, at(v), both[1 - k], snap_);
            pencil.leave_open(both);
            past_both(source, pencil, v, k == 1, LineKind::plane, work, lines);
        }
}

}  // namespace patchlight
