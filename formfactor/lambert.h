#pragma once

#include "meshing/vectors.h"

#include <span>

namespace patchlight {

/// The factor from a point p with unit normal n to a planar convex polygon, nothing in between: the fraction of
/// the power leaving a small area at p that reaches the polygon, if the polygon faces it.
/// Lambert's formula F = (1/2π) Σ θ_i n·(r_i × r_{i+1})/|r_i × r_{i+1}| after clipping at p's horizon.
/// The polygon's vertices run counter-clockwise seen from its front; 0 when p is behind its plane or in it.
/// Exact to rounding. Source: [Lambert1760], see reference-values.md §1.
double lambert_factor(const Vec3& p, const Vec3& n, std::span<const Vec3> polygon);

}  // namespace patchlight
