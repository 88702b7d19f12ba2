#pragma once

#include "formfactor/blockers.h"
#include "formfactor/visible_part.h"

#include <span>

namespace patchlight {

/// Working memory of point_factor.
struct PointScratch {
    std::vector<Blocker> between;
    std::vector<BlockerView> views;
    VisibleScratch visible;
};

/// The factor from the point x with unit normal n to convex facets, exact under occlusion: the fraction of the power
/// leaving a small area at x that reaches their fronts. Each facet is clipped at x's horizon and against all blockers
/// in its shaft, Lambert's formula gives what is left. Heights up to blockers.snap() count as none: a point on a
/// surface isn't hidden by it. Exact but for rounding.
double point_factor(const Blockers& blockers, const Vec3& x, const Vec3& n, std::span<const Facet> to,
                    PointScratch& scratch);

}  // namespace patchlight
