#include "formfactor/shadow_lines.h"

#include "formfactor/shadow_line_finder.h"
#include "meshing/merge_lines.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace patchlight {

namespace {

constexpr double relative_snap = 1e-8;

template <class T>
void make_unique(std::vector<T>& values)
{
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// For the tree, which asks for nothing but corners.
std::vector<Facet> as_facets(const Scene& scene, const std::vector<std::array<std::uint32_t, 2>>& edges)
{
    std::vector<Facet> result(edges.size());
    for (std::size_t k = 0; k < edges.size(); ++k)
        result[k].corners = {scene.vertices[edges[k][0]], scene.vertices[edges[k][1]]};
    return result;
}

}  // namespace

std::vector<ShadowLineFinder::Edge> ShadowLineFinder::edges_of(const Surface& surface) const
{
    std::vector<Edge> edges;
    for (const auto& loop : surface.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const auto [p, q] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
            edges.push_back({p, q});
        }
    return edges;
}

ShadowLineFinder::ShadowLineFinder(const Scene& scene, std::span<const SurfaceId> sources,
                                   const ShadowLineOptions& options)
    : scene_(scene), options_(options), snap_(relative_snap * scene.diameter), facets_(facets_of(scene)),
      tree_(facets_), edge_tree_({}), fans_(scene.vertices.size())
{
    for (const Surface& surface : scene.surfaces) {
        const std::vector<Edge> edges = edges_of(surface);
        edges_.insert(edges_.end(), edges.begin(), edges.end());
    }
    // Of the triangulation: it has the points, too, in which an edge pierces or touches a surface.
    for (const SceneTriangle& t : scene.triangles)
        corners_.insert(corners_.end(), t.vertices.begin(), t.vertices.end());
    make_unique(edges_);
    make_unique(corners_);
    edge_tree_ = FacetTree(as_facets(scene, edges_));
    tbb::parallel_for(std::size_t{0}, corners_.size(),
                      [&](std::size_t k) { fans_[corners_[k]] = corner_fan(tree_, facets_, at(corners_[k]), snap_); });
    for (const SurfaceId id : sources) {
        const Surface& surface = scene.surface(id);
        Source source{id, surface.frame.n, 0, {}, edges_of(surface), facets_of(scene, id)};
        for (const auto& loop : surface.loops) source.corners.insert(source.corners.end(), loop.begin(), loop.end());
        make_unique(source.corners);
        source.offset = glm::dot(source.normal, at(source.corners[0]));
        sources_.push_back(std::move(source));
    }
}

/// The fronts that light through a pencil meets, as seen from the apex.
void ShadowLineFinder::add_hits(const Pencil& pencil, const Vec3& apex, LineKind kind, Work& work, Lines& lines) const
{
    for (const PencilHit& hit : work.pencil.hits) {
        const Facet& facet = facets_[hit.facet];
        const double offset = glm::dot(facet.normal, facet.corners[0]);
        if (glm::dot(facet.normal, apex) - offset <= snap_ || !scene_.material_of(facet.surface).reflects()) continue;
        ++work.counts.receivers;
        const PlaneFrame& frame = scene_.surface(facet.surface).frame;
        const SurfaceLine line{facet.surface, kind, frame.to_plane(pencil.meet(hit.t.from, facet.normal, offset)),
                               frame.to_plane(pencil.meet(hit.t.to, facet.normal, offset))};
        const double length = glm::length(line.end - line.start);
        if (length > snap_ && std::isfinite(length)) lines.push_back(line);
    }
}

/// The light of a point of the source past an edge.
void ShadowLineFinder::past_edge(const Source& source, const Vec3& apex, const Segment& base, LineKind kind, Work& work,
                                 Lines& lines) const
{
    const double h0 = above(source, base[0]), h1 = above(source, base[1]);
    if (h0 <= 0 && h1 <= 0) return;
    const Pencil pencil(tree_, facets_, apex, base, snap_);
    if (!pencil.valid()) return;
    ++work.counts.pencils;
    const Span window{h0 < 0 ? h0 / (h0 - h1) : 0, h1 < 0 ? h0 / (h0 - h1) : 1};
    pencil.beyond(window, work.pencil);
    add_hits(pencil, apex, kind, work, lines);
}

/// The light of a segment of the source past a corner, for the rays that pass on the outline of what is around it.
void ShadowLineFinder::past_corner(const Source& source, std::uint32_t vertex, const Segment& base, LineKind kind,
                                   Work& work, Lines& lines) const
{
    const Vec3& apex = at(vertex);
    if (above(source, apex) <= 0) return;
    const Pencil pencil(tree_, facets_, apex, base, snap_);
    if (!pencil.valid()) return;
    ++work.counts.pencils;
    outline(pencil, fans_[vertex], {0, 1}, kind == LineKind::plane ? Outline::straight : Outline::corner, work);
    for (const Span& part : work.outline) {
        pencil.opposite(part, work.pencil);
        add_hits(pencil, apex, kind, work, lines);
    }
}

/// One element's lines: edges come first, then corners, surfaces, and the source itself.
void ShadowLineFinder::find(const Source& source, std::size_t element, Work& work, Lines& lines) const
{
    if (element < edges_.size()) {
        const Segment base{at(edges_[element][0]), at(edges_[element][1])};
        for (const std::uint32_t apex : source.corners) past_edge(source, at(apex), base, LineKind::ev, work, lines);
        for (const Edge& e : source.edges) {
            const Segment of_source{at(e[0]), at(e[1])};
            if (!in_one_plane(of_source, base)) continue;
            const std::array<Vec3, 5> places = along(of_source);
            for (std::size_t k = 1; k < 4; ++k) past_edge(source, places[k], base, LineKind::ev, work, lines);
        }
        // An edge past which none of these arrives stands in the dark, or as good as.
        if (options_.planes && !lines.empty())
            past_edges_of_one_plane(source, static_cast<std::uint32_t>(element), work, lines);
        return;
    }
    element -= edges_.size();
    if (element < corners_.size()) {
        for (const Edge& e : source.edges)
            past_corner(source, corners_[element], {at(e[0]), at(e[1])}, LineKind::ve, work, lines);
        if (options_.blockers && !lines.empty()) past_corner_and_edges(source, corners_[element], work, lines);
        return;
    }
    if (!options_.planes) return;
    element -= corners_.size();
    if (element < scene_.surfaces.size()) return surface_plane(source, SurfaceId(element), work, lines);
    for (const std::uint32_t apex : source.corners) source_plane(source, at(apex), work, lines);
}

std::vector<SurfaceLine> ShadowLineFinder::find(ShadowLineCounts* counts, const WorkMonitor& monitor) const
{
    const std::size_t elements = edges_.size() + corners_.size() + scene_.surfaces.size() + 1;
    std::vector<Lines> found(sources_.size() * elements);
    tbb::enumerable_thread_specific<Work> work;
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t k) {
        if (!monitor.stop.stop_requested()) find(sources_[k / elements], k % elements, work.local(), found[k]);
    });
    if (monitor.stop.stop_requested()) throw Interrupted();
    if (counts != nullptr)
        for (const Work& w : work) {
            counts->pencils += w.counts.pencils;
            counts->receivers += w.counts.receivers;
        }
    Lines all;
    for (std::size_t s = 0; options_.eee && s < sources_.size(); ++s) {
        std::vector<bool> lit(edges_.size());
        for (std::size_t e = 0; e < edges_.size(); ++e) lit[e] = !found[s * elements + e].empty();
        add_curves(sources_[s], lit, all);
    }
    for (Lines& lines : found) {
        all.insert(all.end(), lines.begin(), lines.end());
        Lines().swap(lines);
    }
    return merged_lines(scene_, std::move(all), snap_);
}

std::vector<SurfaceLine> shadow_lines(const Scene& scene, std::span<const SurfaceId> sources,
                                      const ShadowLineOptions& options, ShadowLineCounts* counts,
                                      const WorkMonitor& monitor)
{
    return ShadowLineFinder(scene, sources, options).find(counts, monitor);
}

}  // namespace patchlight
