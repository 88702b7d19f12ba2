#pragma once

#include "formfactor/blockers.h"
#include "formfactor/form_factors.h"
#include "formfactor/ray_caster.h"
#include "formfactor/work_monitor.h"

namespace patchlight {

/// How pairs of patches were decided.
struct ExactCounts {
    std::size_t facing = 0;   ///< pairs in front of each other's plane
    std::size_t partial = 0;  ///< of these: neither free nor covered by one blocker
    std::size_t nodes = 0;    ///< points at which the visible part was clipped
};

/// The whole matrix, exact under occlusion: every pair of patches is found visible, hidden or partial by its shaft
/// (shaft.h), candidates handed down a tree of patches so that no blocker is missed; visible pairs by
/// unoccluded_exchange, partial ones by clipping (partial_exchange.h) until quartering changes the larger factor by no
/// more than options.tolerance (0: 2e-5). A_i F_ij is computed once a pair: reciprocal to the bit. Nothing is
/// normalised. Columns ascend. raw_sum holds the rows' sums; in a closed scene what is missing from 1 by more than 1e-4
/// is looked for on black backs (add_backs, the only rays), in an open one what is left counts as `escaped`. `occluded`
/// = false: as if nothing stood in between. On all threads, the same bytes on any number. Throws Interrupted.
FormFactorMatrix exact_rows(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                            const FormFactorOptions& options, const WorkMonitor& monitor, bool occluded = true,
                            ExactCounts* counts = nullptr);

}  // namespace patchlight
