#pragma once

#include "formfactor/form_factors.h"
#include "formfactor/hemisphere.h"
#include "formfactor/source.h"
#include "formfactor/work_monitor.h"

#include <span>

namespace patchlight {

/// Working memory of one thread; nothing is allocated ray by ray.
struct RowScratch {
    RayBatch rays;
    HitBatch hits;
    std::vector<PatchId> found;          ///< the patch under each hit
    std::vector<float> weight;           ///< per patch, 0 between rows
    std::vector<std::uint32_t> touched;  ///< patches with weight
    std::vector<ReceiverPoint> receivers;
    std::vector<std::pair<std::size_t, double>> small;  ///< sources to swap, and their unoccluded factors
    std::vector<std::uint8_t> is_swapped;               ///< per surface, 0 between rows
    ShadowScratch shadow;
    FormFactorRow row;       ///< the result
    std::size_t traced = 0;  ///< rays since the scratch was made
};

/// Rows of form factors by rays over the hemisphere, with small sources seen by Lambert's formula. What swapped
/// sources gain or lose against their own hits is taken in proportion from all other rays, those that met nothing
/// included, so that the sum over everything stays. Keeps references to all it is made of.
class RowSampler {
public:
    /// Every row asks each source: with more it would be they that take the time, and each matters little.
    static constexpr std::size_t most_sources = 500;

    /// `sources`: the surfaces that may be seen by Lambert's formula (emitters). Of more than most_sources none is:
    /// rays alone.
    RowSampler(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const PatchLocator& locator,
               std::span<const SurfaceId> sources, const FormFactorOptions& options);

    /// The row of a patch: origins spread over it. Into scratch.row, patches in order of first hit.
    void patch_row(PatchId patch, RowScratch& scratch) const;

    /// The row of a point of a surface. Points with one `direction_key` share their directions: what they don't
    /// resolve then varies smoothly from point to point. `jitter_key` is the point's own.
    void point_row(const Vec3& position, SurfaceId surface, std::uint64_t direction_key, std::uint64_t jitter_key,
                   RowScratch& scratch) const;

    const std::vector<Source>& sources() const { return sources_; }

private:
    void accumulate(const HemisphereSet& set, RowScratch& scratch) const;
    void swap_small_sources(SurfaceId own, std::uint64_t key, RowScratch& scratch) const;
    void collect(RowScratch& scratch) const;
    Vec3 point_of(PatchId patch, float b0, float b1) const;

    const Scene& scene_;
    const RayCaster& caster_;
    const PatchMesh& mesh_;
    const PatchLocator& locator_;
    FormFactorOptions options_;
    std::vector<HemisphereSet> sets_;
    std::vector<Source> sources_;
};

}  // namespace patchlight
