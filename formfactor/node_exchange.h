#pragma once

#include "formfactor/blockers.h"
#include "formfactor/partial_exchange.h"
#include "formfactor/patch_hierarchy.h"
#include "formfactor/ray_caster.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// The mean of the kernel V cos cos'/(π r²) over all pairs of points of two nodes, 1/m²: A_p × mean = what p gets from
/// each W/m² that q sends out. Symmetric. `spread_p`: how far the mean over q alone strays from it from place to place
/// on p, the standard deviation; on a single patch, which has one value anyway, the chance error of `mean`.
struct MeanKernel {
    double mean = 0;
    double spread_p = 0, spread_q = 0;
    double open = 0.5;  ///< the share of rays that can be expected to get through, never quite 0 or 1 by rays alone
    std::uint32_t rays = 0;
    bool best = false;  ///< more rays are of no use
};

/// Estimates the exchange of light between nodes of a PatchHierarchy by rays between few points on both, without bias,
/// of single patches by the closed form times the visible share. What a shaft finds visible or hidden needs no rays.
/// Rays that all agree aren't trusted more than their number allows, so that slits aren't lost; `expected` is the share
/// of rays that got through between the nodes' parents, 1/2 where nothing is known: what is found hidden again and
/// again on the way down is at last believed. Deterministic: keyed by
/// the seed and the nodes. Keeps references. All queries may be made from many threads at once.
class NodeExchange {
    struct Point {
        Vec3 place{0.0}, normal{0.0};
    };
    struct Triangle {
        Vec3 origin{0.0}, u{0.0}, v{0.0}, normal{0.0};
    };

public:
    struct Scratch {
        std::vector<Point> on_p, on_q;
        RayBatch rays;
        std::vector<std::uint8_t> blocked;
        std::vector<double> kernel, row, column;
        std::vector<std::uint32_t> partner;
        std::vector<Vec3> hull_p, hull_q;
        std::vector<Blocker> between;
        PartialScratch partial;
        std::vector<std::uint32_t> in_shaft;
        std::size_t traced = 0;  ///< for for_each_row
    };

    NodeExchange(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const PatchHierarchy& tree,
                 std::uint64_t seed);

    /// See may_face().
    bool may_face(std::uint32_t p, std::uint32_t q) const;
    /// By m² rays from m points to m, m ≥ 2: what mean and spreads are worth grows with m.
    /// Each `draw` has other points.
    MeanKernel between_points(std::uint32_t p, std::uint32_t q, std::uint32_t m, std::uint32_t draw, double expected,
                              Scratch& scratch) const;
    /// Of two single patches: the unoccluded kernel exactly, its visible share by rays weighed by the kernel until the
    /// chance error is below `spread`; when 64 rays don't do and few blockers are near, by partial_exchange, else by at
    /// most 1,024 rays.
    MeanKernel between_patches(std::uint32_t p, std::uint32_t q, double spread, double expected,
                               Scratch& scratch) const;

private:
    struct Share;

    void add_rays(std::uint32_t p, std::uint32_t q, std::uint32_t wanted, Share& share, Scratch& scratch) const;
    void set_points(std::uint32_t p, std::uint32_t q, std::uint32_t m, std::uint32_t draw, Scratch& scratch) const;
    void trace_points(Scratch& scratch) const;
    Point point_on(std::uint32_t node, double along, double across) const;
    Visibility seen_through(std::uint32_t p, std::uint32_t q, std::size_t most, Scratch& scratch) const;

    const Scene& scene_;
    const RayCaster& caster_;
    const PatchMesh& mesh_;
    const PatchHierarchy& tree_;
    Blockers blockers_;
    std::vector<Triangle> triangles_;  ///< of the tree's patches, in its order
    std::uint64_t seed_;
};

}  // namespace patchlight
