#pragma once

#include "formfactor/blockers.h"

#include <span>
#include <vector>

namespace patchlight {

/// Plane coordinates on the polygon that is looked from.
struct OuterPlane {
    Vec3 origin{0.0}, u{0.0}, v{0.0};

    Vec3 lift(const Vec2& q) const { return origin + q.x * u + q.y * v; }
};

/// Part of a line on the outer polygon where what is visible of the target changes its structure: the normal form
/// dot(normal, q) = offset, normal unit, between two ends.
struct ShadowEvent {
    Vec2 normal{0.0};
    double offset = 0;
    Vec2 start{0.0}, end{0.0};
};

/// The lines on the outer polygon along which a blocker's edge begins or ends to hide a corner of the target (EV), a
/// blocker's corner an edge of it (VE), one blocker's corner passes another's edge (both between blockers, as long as
/// these are few), or a blocker is seen edge on: between them what Lambert's formula sums over is analytic, but for the
/// curves where three skew edges meet (EEE), which are not found. No visibility is asked: events that something else
/// hides are among them. Coordinates are those of `plane`; `outer` is convex.
std::vector<ShadowEvent> shadow_events(const OuterPlane& plane, std::span<const Vec2> outer,
                                       std::span<const Vec3> target, std::span<const Blocker> blockers);

}  // namespace patchlight
