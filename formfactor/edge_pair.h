#pragma once

#include "meshing/vectors.h"

namespace patchlight {

/// A directed straight edge.
struct Edge {
    Vec3 start;
    Vec3 direction;     ///< unit
    double length = 0;  ///< > 0
};

/// ∫∫ ln r dr1·dr2 over two edges, what a pair of edges adds to 2π A1 F12 (Stokes' theorem [Sparrow63]).
/// Lengths should be near 1: rounding is relative to their size. Parallel, overlapping and equal edges are exact (two
/// equal ones: L² (ln L − 3/2)); with others the inner integral is exact and the outer one Gauss–Legendre's,
/// piece by piece, as many nodes as the distance to the inner integral's complex singularities asks for, so that
/// edges that meet, cross or pass closely cost more nodes and no accuracy.
/// `tolerance`: of the mean of ln r over both edges, ≥ 1e-16.
double edge_pair_integral(const Edge& outer, const Edge& inner, double tolerance);

}  // namespace patchlight
