#pragma once

#include "formfactor/blockers.h"

#include <cstddef>
#include <span>

namespace patchlight {

/// A_1 F_12 with what is known of its error.
struct ExchangeEstimate {
    double value = 0;  ///< the unit of the coordinates, squared
    double error = 0;  ///< estimated, absolute; an indicator, no bound
    std::size_t nodes = 0;
};

struct OccludedOptions {
    double tolerance = 1e-10;         ///< absolute error asked for, of A_1 F_12
    std::size_t max_nodes = 1 << 21;  ///< then the best so far is returned, with its larger error
};

/// A_1 F_12 = A_2 F_21 of two convex polygons with blockers in between: ∫ over one polygon of Lambert's formula on what
/// clipping leaves visible of the other (visible_part.h). The outer polygon (is_second_outer) is cut along the shadow
/// events (shadow_events.h), so that each cell's integrand is analytic and Gauss's rules converge spectrally; cells
/// whose own shaft is free or covered are exact at once. What EEE curves are left is refined by bisection, worst cell
/// first. A cell that events still cross counts with an error however smooth it looks: a sliver can't be lost, only
/// found to the tolerance. Both polygons must be in front of each other's plane (keep_front), the blockers in front of
/// both (Blockers::between). Swapping the polygons gives the same bits.
ExchangeEstimate occluded_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                                   const Vec3& normal_second, std::span<const Blocker> blockers, double snap,
                                   const OccludedOptions& options = {});

}  // namespace patchlight
