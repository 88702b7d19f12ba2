#pragma once

#include "formfactor/facet_tree.h"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace patchlight {

/// An interval of a pencil's parameter.
struct Span {
    double from = 0, to = 0;
};

/// Where light through a pencil ends: on a facet, for the parameters of an interval.
struct PencilHit {
    std::uint32_t facet = 0;
    Span t;
};

/// Part of a facet's cut with a pencil's plane: 1/μ is linear in t along it.
struct PencilCut {
    double t0 = 0, w0 = 0, t1 = 0, w1 = 0;  ///< t0 < t1; w = 1/μ at both
    std::uint32_t facet = 0;
    unsigned sides = 0;  ///< bits: 1 the facet hides rays just above the plane, 2 below
};

/// Working memory of Pencil.
struct PencilScratch {
    std::vector<PencilCut> cuts, active;
    std::vector<Span> free[2], blocked;
    std::vector<double> stops;
    std::vector<PencilHit> hits;  ///< out
};

/// All lines through an apex that meet a base segment: the directions d(t) = (1 − t)(base0 − apex) + t(base1 − apex),
/// the points apex + μ d(t), so that μ = 1 is the base. What facets hide is decided in the pencil's plane, which each
/// facet that has corners on both sides cuts in a segment. A facet that only touches the plane with an edge hides
/// the side on which it lies: light passes while one side of the plane is free all along. Facets in the plane
/// and cuts along a ray hide nothing.
class Pencil {
public:
    /// `snap`: heights below are nothing, m.
    Pencil(const FacetTree& tree, std::span<const Facet> facets, const Vec3& apex, const std::array<Vec3, 2>& base,
           double snap);

    /// False where apex and base are in a line: nothing may be asked then.
    bool valid() const { return valid_; }

    /// Light from the apex beyond the base: what it meets first, in scratch.hits. Rays of `window` that something cuts
    /// off up to the base itself (other than on one side of the plane) don't get there.
    void beyond(Span window, PencilScratch& scratch) const;
    /// Light from the base beyond the apex.
    void opposite(Span window, PencilScratch& scratch) const;
    /// What is first met from the apex away from the base, on either side of the plane.
    void backward(Span window, PencilScratch& scratch) const;
    /// Light from the apex just above the plane, wherever the base is.
    void outward(Span window, PencilScratch& scratch) const;

    /// Facets that touch the plane along one of these edges hide neither side.
    void leave_open(std::span<const std::array<Vec3, 2>> edges) { open_ = edges; }
    /// The rays that meet a segment in the plane before the base; empty when it isn't wholly there.
    Span window_through(const std::array<Vec3, 2>& segment) const;

    Vec3 direction(double t) const { return (1 - t) * e0_ + t * e1_; }
    /// The point of a plane on the line of t.
    Vec3 meet(double t, const Vec3& normal, double offset) const
    {
        const Vec3 d = direction(t);
        return apex_ + ((offset - glm::dot(normal, apex_)) / glm::dot(normal, d)) * d;
    }
    /// t of a plane through the apex that cuts the base, or −1.
    double parameter_in(const Vec3& normal) const;

private:
    enum class Part { to_base, past_base, past_apex, all };

    void collect(Part part, Span window, std::vector<PencilCut>& cuts) const;
    bool is_open(const std::array<Vec3, 2>& cut) const;
    bool cut(const Facet& facet, double sign, PencilCut& result) const;
    void block(std::span<const PencilCut> cuts, unsigned side, double least, Span window, PencilScratch& scratch) const;
    void trace(Part part, Span window, PencilScratch& scratch) const;
    void nearest(Span window, unsigned side, PencilScratch& scratch) const;
    void nearest_between(double from, double to, PencilScratch& scratch) const;
    bool coincide(const PencilCut& a, const PencilCut& b, double from, double to) const;
    static void add_hit(std::uint32_t facet, double from, double to, PencilScratch& scratch);

    const FacetTree* tree_;
    std::span<const Facet> facets_;
    Vec3 apex_, e0_, e1_, n_{0.0};
    Vec3 alpha_{0.0}, beta_{0.0};  ///< p − apex = α e0 + β e1 for points in the plane
    double height_ = 0;            ///< n · apex
    double reach_ = 0;             ///< from the apex to the base's line, m
    double snap_ = 0;
    std::span<const std::array<Vec3, 2>> open_;
    bool valid_ = false;
};

}  // namespace patchlight
