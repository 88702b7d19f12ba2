#pragma once

#include "formfactor/blocker_cells.h"
#include "formfactor/point_factor.h"
#include "formfactor/work_monitor.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace patchlight {

/// Exact direct factors from points of surfaces to polygonal sources under occlusion: what point_factor gives, without
/// asking the scene's tree at every point. Blockers are found once per surface and convex facet of a source, and then
/// for cells of the surface (see BlockerCells). All points of a planar surface share their horizon, so that clipping
/// sources and blockers there is done once, too.
/// Time and memory to build grow with the surfaces that reflect times the sources' facets, and with their area in
/// cells, which aren't made smaller than 1/128 of the scene's diameter.
class DirectLight {
public:
    /// Working memory of factors(), one per thread.
    struct Scratch {
        std::vector<BlockerView> views;
        PointScratch point;
    };

    /// Built on all threads of the arena; the same at any number of them. Keeps nothing of the scene. Throws
    /// Interrupted.
    DirectLight(const Scene& scene, std::span<const SurfaceId> sources, const WorkMonitor& monitor = {});

    std::size_t source_count() const { return sources_.size(); }
    SurfaceId source(std::size_t k) const { return sources_[k]; }

    /// factors[k]: of source k from x on the front of `surface` (x in the scene's recentred metres; rounding off the
    /// surface's plane or border is forgiven). The fraction of the power leaving a small area at x that reaches the
    /// source's front, 0 for the surface itself. Depends on nothing asked before, to the bit.
    /// Exact but for rounding, and for what protrudes less than Blockers::snap(), as point_factor. Surfaces that
    /// reflect nothing are slower: for them nothing was prepared.
    void factors(const Vec3& x, SurfaceId surface, std::span<double> factors, Scratch& scratch) const;

    std::size_t cell_count() const;
    /// Of memory, the tree of all blockers not counted.
    std::size_t bytes() const;

private:
    /// One convex facet of a source.
    struct Part {
        std::size_t source = 0;
        Facet facet;
        double offset = 0;  ///< of its plane
    };
    /// What of a part a surface's horizon leaves, and what stands in between.
    struct Sight {
        Polygon front;
        BlockerCells cells;
    };
    struct Receiver {
        PlaneRectangle rectangle;
        std::size_t first_sight = no_sights;
    };
    static constexpr std::size_t no_sights = static_cast<std::size_t>(-1);

    void prepare(const Receiver& receiver, const Part& part, double least_side, std::unique_ptr<const Sight>& sight);
    double factor(const Vec3& x, const Receiver& receiver, const Part& part, const Sight* sight,
                  Scratch& scratch) const;

    std::vector<SurfaceId> sources_;
    Blockers blockers_;
    std::vector<Part> parts_;
    std::vector<Receiver> receivers_;                   ///< by surface
    std::vector<std::unique_ptr<const Sight>> sights_;  ///< parts_.size() for each surface that reflects; null: hidden
};

}  // namespace patchlight
