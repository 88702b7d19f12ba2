#pragma once

#include "formfactor/form_factors.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// Directions over the hemisphere about +z, each with the form factor ΔF that it stands for, and with each a
/// stratified place on the unit right triangle (barycentric coordinates) to start from. Several independent sets
/// are made at once; a patch picks one and turns it about its normal, so that no two patches share their error.
struct HemisphereSet {
    std::vector<float> x, y, z;  ///< unit directions, neighbours similar
    std::vector<float> factor;   ///< ΔF of each
    std::vector<float> b0, b1;   ///< barycentric coordinates of the origin
    double sum = 0;              ///< Σ ΔF: 1, but for the lecture's rule

    std::size_t size() const { return x.size(); }
};

/// The sets of directions asked for. `options.rays` is rounded: stratified to rings × sectors, the grids to k·k/4
/// with k a multiple of 4 (k = 45 gives 495 rays; the lecture's k = 64 gives 1,024).
/// Stratified: r = √u, φ = 2πv for the first n points (u, v) of a scrambled net (ScrambledPoints): ΔF = 1/n. Its noise
/// is three quarters of that of points jittered in rings × sectors strata.
std::vector<HemisphereSet> hemisphere_sets(const FormFactorOptions& options, int count);

/// The lecture's grid: φ = lΔφ, θ = (m + ½)Δθ, Δφ = Δθ = 2π/k; `exact_rings` weighs ring m with
/// (sin²θ_{m+1} − sin²θ_m)/k, else with the lecture's (2π/k²) sin 2θ, which sums to Δθ·cot Δθ.
/// Throws std::invalid_argument unless k ≥ 8 is a multiple of 4.
HemisphereSet regular_grid(int k, bool exact_rings);

/// Turns the set's directions by `turn` radians about the frame's normal and writes them as rays without an end; the
/// origins are the caller's to set.
void aim(const HemisphereSet& set, const PlaneFrame& frame, double turn, RayBatch& rays);

/// Which of several sets a key picks, and by how much it is turned.
struct PickedSet {
    std::size_t index = 0;
    double turn = 0;  ///< radians
};
PickedSet pick_set(std::size_t sets, std::uint64_t seed, std::uint64_t key);

/// aim(), all rays from one place, already off its surface (RayCaster::leave).
void aim_from(const Vec3& start, const HemisphereSet& set, const PlaneFrame& frame, double turn, RayBatch& rays);

}  // namespace patchlight
