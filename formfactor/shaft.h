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

/// What lies between two convex polygons of different planes.
enum class Visibility {
    visible,  ///< nothing stands in between
    hidden,   ///< no segment between them is free, or one is behind the other's plane
    partial   ///< cannot tell more
};

/// How one blocker stands in a shaft: `visible` when it was found to cross no segment by more than `snap` (m) of its
/// rim, `hidden` when it crosses every segment. Conservative: `partial` may still be either. First the blocker's own
/// plane; if that parts a from b, the sides on which all lines between corners pass the blocker's edges (linear in both
/// ends, so that corners decide); else a few steps of a separating direction [ChungWang96] and the shaft's side planes.
Visibility visibility_past(const Shaft& shaft, const BlockerView& blocker, double snap);

}  // namespace patchlight
