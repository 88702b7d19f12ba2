#pragma once

#include "meshing/surface_triangulation.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// A straight piece between two points of a plane.
struct PlanePiece {
    std::array<std::uint32_t, 2> points{};
    LineKind kind = LineKind::contact;
    bool border = false;       ///< the surface lies on its left only
    std::uint32_t origin = 0;  ///< which of the pieces given it is part of, for border pieces
};

/// Points and pieces between them, in MeshingPlane's coordinates.
struct LineArrangement {
    std::vector<Vec2> points;
    std::vector<PlanePiece> pieces;
};

/// Adds lines to pieces that meet in points only, and divides all until that holds again: where two cross, at a new
/// point or one nearer than `merge`; where a point is nearer than `merge` to a line, which then goes through it. What
/// comes that near to the border lies on it. Of equal pieces the border remains, else the lowest kind. The points given
/// stay where they are, and the border stays straight; new points are rounded as MeshingPlane does.
LineArrangement arrange_lines(LineArrangement given, std::span<const SurfaceLine> lines, double merge);

}  // namespace patchlight
