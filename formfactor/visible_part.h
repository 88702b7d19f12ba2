#pragma once

#include "formfactor/convex_polygon.h"
#include "formfactor/shaft.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// Working memory of visible_factor, reused from call to call.
struct VisibleScratch {
    Polygon whole;                      ///< the polygon relative to the point
    std::vector<Polygon> pieces, next;  ///< what of it is still visible
    std::vector<double> heights;        ///< of the corners of one piece over the planes through one blocker's edges
    std::vector<Vec3> planes;
    std::vector<std::uint32_t> last_edges;  ///< of each blocker: the one that left the polygon outside last time
    bool cut = false;                       ///< out: whether any blocker took something away
};

/// The factor of the visible part of a convex polygon from the point x with normal n: the polygon is clipped against
/// the cone from x through each blocker, and Lambert's formula summed over the pieces left [Lambert1760].
/// The whole polygon and all blockers must lie in front of x's horizon, and the blockers in front of the polygon's
/// plane (see keep_front): then what a ray meets on its way to the polygon is exactly what lies in its cone.
/// No decision needs an exact sign: a corner on a cone's plane belongs to either side with the same result.
/// 0 when x is behind the polygon or in its plane.
/// Neighbouring points with the same blockers are faster: scratch remembers which edges part them from the polygon.
double visible_factor(const Vec3& x, const Vec3& n, std::span<const Vec3> polygon,
                      std::span<const BlockerView> blockers, VisibleScratch& scratch);

/// Which of two polygons to integrate the other's visible part over: true for the second. The smaller where sizes
/// differ by a factor of 3, since a large one close to it would need nodes everywhere; else the one farther from the
/// blockers, where the light varies less. Swapping the polygons swaps the answer.
bool is_second_outer(std::span<const Vec3> first, std::span<const Vec3> second, std::span<const BlockerView> blockers);

}  // namespace patchlight
