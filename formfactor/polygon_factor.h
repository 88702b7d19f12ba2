#pragma once

#include "meshing/vectors.h"

#include <span>

namespace patchlight {

/// A1 F12 = A2 F21 (the unit of the coordinates, squared) between two planar convex polygons with nothing in between:
/// A1 F12 = (1/2π) ∮∮ ln r dr1·dr2 over what lies in front of the other's plane [Sparrow63]. The inner contour
/// integral is exact, the outer one exact for parallel edges (so shared and partly shared ones) and Gauss–Legendre's
/// else. Where the contours cancel, the areas are integrated: of polygons 15 times their radii apart, and Lambert's
/// formula over one that is 15 times smaller than the other and as far from its edges.
/// Vertices run counter-clockwise seen from the front (any number ≥ 3, in one plane and convex to 1e-6 of the
/// polygon's size). Swapping the polygons gives the same bits; moving, turning and scaling them the same factor but
/// for rounding. Polygons that cross each other exchange light between the parts in front of each other's planes.
/// `tolerance`, 1e-15 … 1e-2, bounds the error relative to the smaller area: so it is the absolute error of the larger
/// of both factors. A small polygon close to an edge of one 10^k times wider loses up to 2k digits to rounding.
/// Throws std::invalid_argument, saying which of the two and why, for fewer than 3 vertices, values that aren't
/// finite, no area, a polygon not planar or not convex, and for a tolerance out of its range.
double polygon_exchange(std::span<const Vec3> first, std::span<const Vec3> second, double tolerance = 1e-12);

/// The same for what clipping leaves of such polygons, with their normals: corners may nearly coincide and slivers have
/// next to no area, so no shape is checked and nothing is thrown. Never negative. Of a sliver rounding may leave errors
/// of 1e-14 of the other's size, squared.
double fragment_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                         const Vec3& normal_second, double tolerance = 1e-12);

/// The form factor F12 = polygon_exchange / A1: the fraction of the power leaving `from` that reaches `to`. In [0, 1]
/// but for rounding; exactly 0 when either is behind the other's plane or in it.
double polygon_factor(std::span<const Vec3> from, std::span<const Vec3> to, double tolerance = 1e-12);

}  // namespace patchlight
