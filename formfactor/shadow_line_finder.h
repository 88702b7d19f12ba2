#pragma once

#include "formfactor/corner_fan.h"
#include "formfactor/pencil.h"
#include "formfactor/shadow_lines.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace patchlight {

/// What shadow_lines() is made of.
class ShadowLineFinder {
public:
    ShadowLineFinder(const Scene& scene, std::span<const SurfaceId> sources, const ShadowLineOptions& options);

    std::vector<SurfaceLine> find(ShadowLineCounts* counts, const WorkMonitor& monitor) const;

private:
    using Lines = std::vector<SurfaceLine>;
    using Edge = std::array<std::uint32_t, 2>;
    using Segment = std::array<Vec3, 2>;

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

    /// From a place on a source's edge past a point of each of two edges, with the edges' directions.
    struct Ray {
        Vec3 from{0.0};
        std::array<Vec3, 2> past, along;
    };
    class Regulus;

    /// What a curve's ray meets, from its place t on.
    struct Met {
        double t = 0;
        std::optional<SurfaceId> surface;
    };

    struct EdgePair {
        double distance = 0;  ///< of the middles: twice, squared
        std::uint32_t near = 0, far = 0;
    };

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
    void outline(const Pencil& pencil, const CornerFan& fan, Span window, Outline least, Work& work) const;
    void past_corner_and_edges(const Source& source, std::uint32_t vertex, Work& work, Lines& lines) const;
    void past_both(const Source& source, const Pencil& pencil, std::uint32_t apex, bool before, LineKind kind,
                   Work& work, Lines& lines) const;
    void source_plane(const Source& source, const Vec3& apex, Work& work, Lines& lines) const;
    void surface_plane(const Source& source, SurfaceId surface, Work& work, Lines& lines) const;
    void past_edges_of_one_plane(const Source& source, std::uint32_t edge, Work& work, Lines& lines) const;
    void past_two_edges(const Source& source, std::uint32_t near, std::uint32_t far, const Vec3& normal, Work& work,
                        Lines& lines) const;
    std::vector<FacetTree::HalfSpace> shadow_of(const Source& source, const Segment& edge) const;
    bool has(const Facet& facet, const Vec3& p, double slack, bool& inside) const;
    std::array<FacetTree::HalfSpace, 6> around(const Vec3& from, const Vec3& d, double until) const;
    bool passes(const Ray& ray) const;
    std::optional<std::uint32_t> receiver(const Ray& ray) const;
    std::optional<SurfaceId> met_by(const Ray& ray) const;
    void add_changes(const Regulus& regulus, const Met& a, const Met& b, std::vector<Met>& changes) const;
    void add_arc(const Regulus& regulus, SurfaceId surface, Span part, int depth, Lines& lines) const;
    void past_skew_edges(const Source& source, const Segment& edge, const Segment& near, const Segment& far,
                         Lines& lines) const;
    std::optional<Segment> in_front(const Source& source, const Edge& edge) const;
    std::vector<EdgePair> skew_pairs(const Source& source, const std::vector<bool>& lit) const;
    void add_curves(const Source& source, const std::vector<bool>& lit, Lines& lines) const;
    std::vector<Segment> chords(const Source& source, const Vec3& normal, const Vec3& through) const;
    /// The ends of a segment of the source and places in between: where an edge lies in one plane with the segment,
    /// something else may hide both ends.
    static std::array<Vec3, 5> along(const Segment& s)
    {
        return {s[0], 0.75 * s[0] + 0.25 * s[1], 0.5 * (s[0] + s[1]), 0.25 * s[0] + 0.75 * s[1], s[1]};
    }
    bool in_one_plane(const Segment& a, const Segment& b) const;
    bool skew(const Segment& a, const Segment& b) const;
    std::vector<Edge> edges_of(const Surface& surface) const;
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
    std::vector<CornerFan> fans_;  ///< by vertex
};

}  // namespace patchlight
