#include "formfactor/shadow_line_finder.h"

#include <algorithm>

namespace patchlight {

/// The parts of a window whose rays pass an outline of what stands around the apex, a corner of it or a straight one.
void ShadowLineFinder::outline(const Pencil& pencil, const CornerFan& fan, Span window, Outline least, Work& work) const
{
    work.outline.clear();
    work.stops.assign({window.from, window.to});
    for (const Vec3& normal : fan.normals) {
        const double t = pencil.parameter_in(normal);
        if (t > window.from && t < window.to) work.stops.push_back(t);
    }
    std::ranges::sort(work.stops);
    for (std::size_t k = 0; k + 1 < work.stops.size(); ++k) {
        const Span part{work.stops[k], work.stops[k + 1]};
        if (!(part.to > part.from) || fan.outline(pencil.direction(0.5 * (part.from + part.to))) < least) continue;
        if (!work.outline.empty() && work.outline.back().to == part.from)
            work.outline.back().to = part.to;
        else
            work.outline.push_back(part);
    }
}

/// Where the source's light past a corner passes an edge, too, before or after.
void ShadowLineFinder::past_corner_and_edges(const Source& source, std::uint32_t vertex, Work& work, Lines& lines) const
{
    const Vec3& apex = at(vertex);
    if (above(source, apex) <= 0) return;
    const CornerFan& fan = fans_[vertex];
    if (std::ranges::none_of(source.corners,
                             [&](std::uint32_t c) { return fan.outline(apex - at(c)) == Outline::corner; }))
        return;
    for (const Facet& facet : source.facets)
        for (const double sign : {1.0, -1.0}) {
            // Towards the source within the cone over it, and away from it in the opposite one.
            std::vector<FacetTree::HalfSpace> cone;
            if (sign > 0) cone.push_back({source.normal, source.offset + snap_});
            for (std::size_t k = 0; k < facet.corners.size(); ++k) {
                const Vec3 m =
                    -sign * glm::cross(facet.corners[k] - apex, facet.corners[(k + 1) % facet.corners.size()] - apex);
                cone.push_back({m, glm::dot(m, apex)});
            }
            edge_tree_.visit(cone, [&](std::uint32_t e) {
                const Segment base{at(edges_[e][0]), at(edges_[e][1])};
                const auto beyond = [&](const FacetTree::HalfSpace& h) {
                    return glm::dot(h.normal, base[0]) <= h.offset && glm::dot(h.normal, base[1]) <= h.offset;
                };
                if (edges_[e][0] == vertex || edges_[e][1] == vertex || std::ranges::any_of(cone, beyond)) return true;
                const Pencil pencil(tree_, facets_, apex, base, snap_);
                past_both(source, pencil, vertex, sign > 0, LineKind::ve, work, lines);
                return true;
            });
        }
}

/// Light of the source past the base of a pencil and its apex, the base `before` the apex (on the source's side) or
/// after.
void ShadowLineFinder::past_both(const Source& source, const Pencil& pencil, std::uint32_t vertex, bool before,
                                 LineKind kind, Work& work, Lines& lines) const
{
    if (!pencil.valid()) return;
    ++work.counts.pencils;
    if (before)
        pencil.beyond({0, 1}, work.pencil);
    else
        pencil.backward({0, 1}, work.pencil);
    work.lit.clear();
    for (const PencilHit& hit : work.pencil.hits)
        if (facets_[hit.facet].surface == source.surface) work.lit.push_back(hit.t);
    for (const Span& lit : work.lit) {
        outline(pencil, fans_[vertex], lit, kind == LineKind::plane ? Outline::straight : Outline::corner, work);
        for (const Span& part : work.outline) {
            if (before)
                pencil.backward(part, work.pencil);
            else
                pencil.beyond(part, work.pencil);
            add_hits(pencil, at(vertex), kind, work, lines);
        }
    }
}

}  // namespace patchlight
