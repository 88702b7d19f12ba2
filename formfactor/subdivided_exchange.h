#pragma once

#include "formfactor/blockers.h"
#include "formfactor/occluded_exchange.h"
#include "formfactor/ray_caster.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace patchlight {

/// A_1 F_12 of pairs of convex polygons by subdivision. What the blockers leave visible is polygon_exchange's, what
/// they hide is nothing; in between a pair's unoccluded exchange (exact too, so that polygons may touch) is multiplied
/// by the share that rays between nodes on both find visible, weighed by the kernel cos cos/(π r²). The pair with the
/// largest error is cut in halves across the longer of both polygons, over and over. The nodes of each pair are a
/// scrambled net of their own (ScrambledPoints): those of Gauss's rules would meet blockers' edges that run along the
/// polygons' all at once, and their errors would add up instead of averaging out.
/// A pair that something may partly hide keeps an error however much its rays agree: narrow slits are not lost.
/// Deterministic: keyed by the seed and the order of the pairs. One object a thread; keeps references.
class SubdividedExchange {
public:
    SubdividedExchange(const Blockers& blockers, const RayCaster& caster) : blockers_(blockers), caster_(caster) {}

    /// Forgets all pairs.
    void start(std::uint64_t seed, std::uint64_t key);
    /// Adds a pair; returns its unoccluded exchange, 0 where nothing is seen.
    double add(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b, const Vec3& normal_b);
    /// Traces and cuts until the error, the root of the pairs' squares, is below options.tolerance (the unit of the
    /// coordinates, squared) or options.max_nodes rays are traced. `parallel`: on all threads, with the same result.
    ExchangeEstimate refine(const OccludedOptions& options, bool parallel);

private:
    struct Root {
        Vec3 normal_a, normal_b;
    };
    struct Cell {
        Polygon a, b;
        std::shared_ptr<const std::vector<Blocker>> blockers;  ///< in its shaft, and perhaps some more
        std::size_t root = 0;
        std::uint64_t key = 0;
        double unoccluded = 0, value = 0, error = 0;
    };
    struct Scratch;

    void cut(const Cell& parent, bool upper, Cell& child, Scratch& scratch) const;
    void sample(Cell& cell, Scratch& scratch) const;
    template <class Work>
    static void for_each(std::size_t n, bool parallel, const Work& work);

    const Blockers& blockers_;
    const RayCaster& caster_;
    std::vector<Root> roots_;
    std::vector<Cell> cells_;  ///< a heap by error, once refined
    std::vector<Blocker> found_;
    std::uint64_t seed_ = 0, key_ = 0;
    double visible_ = 0;     ///< exchange that is done with
    std::size_t exact_ = 0;  ///< pairs that needed no rays
};

}  // namespace patchlight
