#pragma once

#include "formfactor/corner_fan.h"
#include "formfactor/pencil.h"
#include "formfactor/shadow_lines.h"

#include <array>
#include <cmath>
#include <cstdint>
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
    std::vector<Segment> chords(const Source& source, const Vec3& normal, const Vec3& through) const;
    /// The ends of a segment of the source and places in between: where an edge lies in one plane with the segment,
    /// something else may hide both ends.
    static std::array<Vec3, 5> along(const Segment& s)
    {
        return {s[0], 0.75 * s[0] + 0.25 * s[1], 0.5 * (s[0] + s[1]), 0.25 * s[0] + 0.75 * s[1], s[1]};
    }
    bool in_one_plane(const Segment& a, const Segment& b) const;
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
