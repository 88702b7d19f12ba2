#pragma once

#include "meshing/vectors.h"

#include <boost/container/small_vector.hpp>

#include <span>

namespace patchlight {

/// The corners of a planar convex polygon, made and remade in hot loops: up to 8 without allocating.
struct Polygon : boost::container::small_vector<Vec3, 8> {
    using small_vector::small_vector;
    // Boost's iterators aren't contiguous ones to C++20: std::span needs telling.
    operator std::span<const Vec3>() const { return {data(), size()}; }
};

/// The area times the unit normal of the front; 0 for fewer than three corners.
Vec3 area_vector(std::span<const Vec3> polygon);

/// An order of points by x, then y, then z, and of polygons by their corners: whoever computes something of two sides
/// in this order gets the same bits both ways round.
bool precedes(const Vec3& p, const Vec3& q);
bool precedes(std::span<const Vec3> a, std::span<const Vec3> b);

/// What of a convex polygon lies in front of a plane, dot(n, p) ≥ offset [SutherlandHodgman74]. Corners within `snap`
/// of the plane (in the unit of dot(n, p)) count as in it; nothing is left when no corner is in front by more.
void keep_front(std::span<const Vec3> polygon, const Vec3& n, double offset, double snap, Polygon& kept);

/// From one corner to the one farthest from it, of the two farthest apart.
Vec3 longest_extent(std::span<const Vec3> polygon);

/// The half of a convex polygon on the side that `axis` points to, cut across the middle of its extent along it.
void keep_half(std::span<const Vec3> polygon, const Vec3& axis, Polygon& kept);

/// The square of the distance from a point to a polygon's rim.
double squared_distance_to_rim(const Vec3& p, std::span<const Vec3> polygon);

}  // namespace patchlight
