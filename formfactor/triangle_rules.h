#pragma once

#include <span>

namespace patchlight {

/// A node of a quadrature rule over a triangle (a, b, c): the point a + b1 (b − a) + b2 (c − a), inside; the weights
/// sum to 1, so that area × Σ weight × f is the integral.
struct TriangleNode {
    double b1 = 0, b2 = 0, weight = 0;
};

/// The smallest of our rules that is exact for polynomials of total degree `degree` ≤ 15: 1 (centroid), 2 (3 nodes),
/// 5 (7 nodes, [Radon48]), then Gauss–Legendre rules folded onto the triangle, n² nodes for degree 2n − 2.
std::span<const TriangleNode> triangle_rule(int degree);

}  // namespace patchlight
