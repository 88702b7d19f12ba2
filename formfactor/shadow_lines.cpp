#include "formfactor/shadow_lines.h"

#include "formfactor/corner_fan.h"
#include "formfactor/pencil.h"
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

using Edge = std::array<std::uint32_t, 2>;
using Segment = std::array<Vec3, 2>;

std::vector<Edge> edges_of(const Surface& surface)
{
    std::vector<Edge> edges;
    for (const auto& loop : surface.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const auto [p, q] = std::minmax(loop[k], loop[(k + 1) % loop.size()]);
            edges.push_back({p, q});
        }
    return edges;
}

template <class T>
void make_unique(std::vector<T>& values)
{
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// For the tree, which asks for nothing but corners.
std::vector<Facet> as_facets(const Scene& scene, const std::vector<Edge>& edges)
{
    std::vector<Facet> result(edges.size());
    for (std::size_t k = 0; k < edges.size(); ++k)
        result[k].corners = {scene.vertices[edges[k][0]], scene.vertices[edges[k][1]]};
    return result;
}

struct Source {
    SurfaceId surface;
    Vec3 normal{0.0};
    double offset = 0;
    std::vector<std::uint32_t> corners;
    std::vector<Edge> edges;
    std::vector<Facet> facets;
};

/// Working memory of one thread.
struct Work {
    PencilScratch pencil;
    std::vector<double> stops;
    std::vector<Span> outline, lit;
    ShadowLineCounts counts;
};

class LineFinder {
public:
    LineFinder(const Scene& scene, std::span<const SurfaceId> sources, const ShadowLineOptions& options);

    std::vector<SurfaceLine> find(ShadowLineCounts* counts) const;

private:
    using Lines = std::vector<SurfaceLine>;

    const Vec3& at(std::uint32_t vertex) const { return scene_.vertices[vertex]; }
    double above(const Source& s, const Vec3& p) const
    {
        const double h = glm::dot(s.normal, p) - s.offset;
        return std::abs(h) <= snap_ ? 0 : h;
    }
    void past_edge(const Source& source, const Vec3& apex, const Segment& base, LineKind kind, Work& work,
                   Lines& lines) const;
    void past_corner(const Source& source, std::uint32_t apex, const Segment& base, LineKind kind, Work& work,
                     Lines& lines) const;
    void outline(const Pencil& pencil, const CornerFan& fan, Span window, Work& work) const;
    void past_corner_and_edges(const Source& source, std::uint32_t vertex, Work& work, Lines& lines) const;
    void past_both(const Source& source, const Vec3& apex, const CornerFan& fan, const Segment& base, bool before,
                   Work& work, Lines& lines) const;
    void source_plane(const Source& source, const Vec3& apex, Work& work, Lines& lines) const;
    void surface_plane(const Source& source, SurfaceId surface, Work& work, Lines& lines) const;
    void add_hits(const Pencil& pencil, const Vec3& apex, LineKind kind, Work& work, Lines& lines) const;
    void find(const Source& source, std::size_t element, Work& work, Lines& lines) const;

    const Scene& scene_;
    ShadowLineOptions options_;
    double snap_;
    std::vector<Facet> facets_;
    FacetTree tree_;
    FacetTree edge_tree_;
    std::vector<Source> sources_;
    std::vector<Edge> edges_;
    std::vector<std::uint32_t> corners_;
    std::vector<CornerFan> fans_;  ///< by vertex; empty where no loop has it
};

LineFinder::LineFinder(const Scene& scene, std::span<const SurfaceId> sources, const ShadowLineOptions& options)
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
void LineFinder::add_hits(const Pencil& pencil, const Vec3& apex, LineKind kind, Work& work, Lines& lines) const
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
void LineFinder::past_edge(const Source& source, const Vec3& apex, const Segment& base, LineKind kind, Work& work,
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
void LineFinder::past_corner(const Source& source, std::uint32_t vertex, const Segment& base, LineKind kind, Work& work,
                             Lines& lines) const
{
    const Vec3& apex = at(vertex);
    if (above(source, apex) <= 0) return;
    const Pencil pencil(tree_, facets_, apex, base, snap_);
    if (!pencil.valid()) return;
    ++work.counts.pencils;
    outline(pencil, fans_[vertex], {0, 1}, work);
    for (const Span& part : work.outline) {
        pencil.opposite(part, work.pencil);
        add_hits(pencil, apex, kind, work, lines);
    }
}

/// The parts of a window whose rays pass a corner of what stands around the apex.
void LineFinder::outline(const Pencil& pencil, const CornerFan& fan, Span window, Work& work) const
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
        if (!(part.to > part.from) || !fan.has_corner(pencil.direction(0.5 * (part.from + part.to)))) continue;
        if (!work.outline.empty() && work.outline.back().to == part.from)
            work.outline.back().to = part.to;
        else
            work.outline.push_back(part);
    }
}

/// Where the source's light past a corner passes an edge, too, before or after.
void LineFinder::past_corner_and_edges(const Source& source, std::uint32_t vertex, Work& work, Lines& lines) const
{
    const Vec3& apex = at(vertex);
    if (above(source, apex) <= 0) return;
    const CornerFan& fan = fans_[vertex];
    if (std::ranges::none_of(source.corners, [&](std::uint32_t c) { return fan.has_corner(apex - at(c)); })) return;
    for (const Facet& facet : source.facets)
        for (const double sign : {1.0, -1.0}) {
            // Towards the source within the cone over it, and away from it in the opposite one.
            std::vector<FacetTree::HalfSpace> cone;
            if (sign > 0) cone.push_back({source.normal, source.offset + snap_});
            for (std::size_t k = 0; k < facet.corners.size(); ++k) {
                const Vec3 m = -sign * glm::cross(facet.corners[k] - apex,
                                                  facet.corners[(k + 1) % facet.corners.size()] - apex);
                cone.push_back({m, glm::dot(m, apex)});
            }
            edge_tree_.visit(cone, [&](std::uint32_t e) {
                const Segment base{at(edges_[e][0]), at(edges_[e][1])};
                const auto beyond = [&](const FacetTree::HalfSpace& h) {
                    return glm::dot(h.normal, base[0]) <= h.offset && glm::dot(h.normal, base[1]) <= h.offset;
                };
                if (edges_[e][0] != vertex && edges_[e][1] != vertex && std::ranges::none_of(cone, beyond))
                    past_both(source, apex, fan, base, sign > 0, work, lines);
                return true;
            });
        }
}

/// The same for one edge, `before` the corner (on the source's side) or after it.
void LineFinder::past_both(const Source& source, const Vec3& apex, const CornerFan& fan, const Segment& base,
                           bool before, Work& work, Lines& lines) const
{
    const Pencil pencil(tree_, facets_, apex, base, snap_);
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
        outline(pencil, fan, lit, work);
        for (const Span& part : work.outline) {
            if (before)
                pencil.backward(part, work.pencil);
            else
                pencil.beyond(part, work.pencil);
            add_hits(pencil, apex, LineKind::ve, work, lines);
        }
    }
}

/// Where the source's own plane meets others, as far as its corners see it.
void LineFinder::source_plane(const Source& source, const Vec3& apex, Work& work, Lines& lines) const
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
void LineFinder::surface_plane(const Source& source, SurfaceId id, Work& work, Lines& lines) const
{
    const Surface& surface = scene_.surface(id);
    const Vec3 n = surface.frame.n;
    const double offset = glm::dot(n, surface.frame.origin);
    if (id == source.surface) return;
    if (std::ranges::none_of(surface.loops[0], [&](std::uint32_t v) { return above(source, at(v)) > 0; })) return;
    for (const Facet& facet : facets_) {
        if (facet.surface != source.surface) continue;
        std::vector<Vec3> ends;
        const auto height = [&](const Vec3& p) {
            const double h = glm::dot(n, p) - offset;
            return std::abs(h) <= snap_ ? 0.0 : h;
        };
        Vec3 last = facet.corners.back();
        for (const Vec3& p : facet.corners) {
            const double h0 = height(last), h1 = height(p);
            if (h1 == 0) ends.push_back(p);
            if (h0 * h1 < 0) ends.push_back(last + (h0 / (h0 - h1)) * (p - last));
            last = p;
        }
        if (ends.size() != 2) continue;
        for (const Edge& e : edges_of(surface))
            for (const Vec3& end : ends) past_edge(source, end, {at(e[0]), at(e[1])}, LineKind::plane, work, lines);
        for (const auto& loop : surface.loops)
            for (const std::uint32_t v : loop) past_corner(source, v, {ends[0], ends[1]}, LineKind::plane, work, lines);
    }
}

/// One element's lines: edges come first, then corners, surfaces, and the source itself.
void LineFinder::find(const Source& source, std::size_t element, Work& work, Lines& lines) const
{
    if (element < edges_.size()) {
        const Segment base{at(edges_[element][0]), at(edges_[element][1])};
        for (const std::uint32_t apex : source.corners) past_edge(source, at(apex), base, LineKind::ev, work, lines);
        return;
    }
    element -= edges_.size();
    if (element < corners_.size()) {
        for (const Edge& e : source.edges)
            past_corner(source, corners_[element], {at(e[0]), at(e[1])}, LineKind::ve, work, lines);
        if (options_.blockers) past_corner_and_edges(source, corners_[element], work, lines);
        return;
    }
    if (!options_.planes) return;
    element -= corners_.size();
    if (element < scene_.surfaces.size()) return surface_plane(source, SurfaceId(element), work, lines);
    for (const std::uint32_t apex : source.corners) source_plane(source, at(apex), work, lines);
}

std::vector<SurfaceLine> LineFinder::find(ShadowLineCounts* counts) const
{
    const std::size_t elements = edges_.size() + corners_.size() + scene_.surfaces.size() + 1;
    std::vector<Lines> found(sources_.size() * elements);
    tbb::enumerable_thread_specific<Work> work;
    tbb::parallel_for(std::size_t{0}, found.size(),
                      [&](std::size_t k) { find(sources_[k / elements], k % elements, work.local(), found[k]); });
    if (counts != nullptr)
        for (const Work& w : work) {
            counts->pencils += w.counts.pencils;
            counts->receivers += w.counts.receivers;
        }
    Lines all;
    for (Lines& lines : found) {
        all.insert(all.end(), lines.begin(), lines.end());
        Lines().swap(lines);
    }
    return merged_lines(scene_, std::move(all), snap_);
}

}  // namespace

std::vector<SurfaceLine> shadow_lines(const Scene& scene, std::span<const SurfaceId> sources,
                                      const ShadowLineOptions& options, ShadowLineCounts* counts)
{
    return LineFinder(scene, sources, options).find(counts);
}

}  // namespace patchlight
