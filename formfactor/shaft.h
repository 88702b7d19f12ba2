#pragma once

#include "meshing/vectors.h"

#include <span>

namespace patchlight {

/// The volume between two convex polygons of different planes: all segments from one to the other.
struct Shaft {
    std::span<const Vec3> a, b;
};

/// A convex polygon in the way, with its plane: dot(normal, p) = offset.
struct BlockerView {
    std::span<const Vec3> corners;
    Vec3 normal{0.0};
    double offset = 0;
};

/// Whether a separating plane was found between a shaft and a blocker, that may touch by `snap` (m): no segment of the
/// shaft crosses more than the blocker's rim. Conservative: where it says false they may still be apart.
/// Tries the blocker's own plane, a few steps of a separating direction [ChungWang96], then the shaft's side planes.
bool is_clear(const Shaft& shaft, const BlockerView& blocker, double snap);

/// Whether every segment of the shaft crosses the blocker: its plane lies between a and b, and no corner of one sees
/// a corner of the other past an edge (the test is linear in both points, so that corners decide).
bool is_covered(const Shaft& shaft, const BlockerView& blocker);

}  // namespace patchlight
