#pragma once

#include "formfactor/convex_polygon.h"

#include <array>
#include <span>
#include <vector>

namespace patchlight {

/// Patches of one surface in the form the hot loop wants: places of quadrature nodes by coordinate, node after node,
/// each for all patches of the block.
struct NodeBlock {
    Vec3 normal{0.0};  ///< of all patches
    std::size_t count = 0;
    std::vector<double> x, y, z;  ///< node k of patch j at k · count + j
    std::vector<double> weight;   ///< of node k alone: weights sum to 1
};

/// The nodes of triangle_rule(degree) on each triangle.
NodeBlock node_block(std::span<const std::array<Vec3, 3>> triangles, const Vec3& normal, int degree);

/// out[j] = Σ_k Σ_l w_k w_l cos θ cos θ' / (π r²): the mean kernel between one triangle and each of a block, times both
/// areas A_1 F_12. Both sides must lie in front of each other's plane. Relative error of the rules of degree 5 at ρ
/// radii (the distance of the centroids over the sum of both circumradii about them): 2e-6 at 2, 1e-7 at 3, 7e-9 at 5;
/// of degree 2: 2e-6 at 10, 7e-7 at 14; of degree 8: 8e-8 at 1.3, 1e-9 at 2 (rms over random pairs). `from`: nodes of
/// one triangle (count = 1).
void mean_kernel(const NodeBlock& from, const NodeBlock& to, std::span<double> out);

/// A_1 F_12 of two convex polygons in front of each other's plane, nothing in between, to about 1e-7 of the kernel's
/// mean: by nodes on both where they are 1.3 radii apart, else by fragment_exchange.
double unoccluded_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                           const Vec3& normal_second);

}  // namespace patchlight
