#pragma once

#include "solver/estimate.h"
#include "solver/solve.h"

#include <span>

namespace patchlight {

/// What is looked at: for each patch the share of the samples that see it, of a picture's rays or of points to probe;
/// they sum to 1. Invalid ids (the background, black backs) don't count; nothing seen: all 0.
PatchField<double> seen_shares(std::size_t patches, std::span<const PatchId> seen);

/// The dual solution for the goal J = Σ_i seen_i B_i, each band for itself [SmitsArvoSalesin92].
struct Importance {
    PatchField<Rgb> density;  ///< Y, 1/m²: J = Σ_i A_i Y_i E_i; what J gains from 1 W more that leaves the patch
    SolveReport solved;       ///< of the linear system, as in SolveOptions
};

/// Y_i = seen_i/A_i + Σ_j F_ij ρ_j Y_j: by reciprocity importance is gathered with the rows that gather light. Exact on
/// reciprocal rows; on sampled ones an estimate as noisy as they are. `F` may be rows_of(system.F) or any other
/// operator; of `system` areas and ρ are taken. By BiCGStab to options.tolerance. Throws Interrupted.
Importance importance(const RadiositySystem& system, const LightOperator& F, const PatchField<double>& seen,
                      const SolveOptions& options = {.tolerance = 0.01}, const WorkMonitor& monitor = {});

/// How much a patch's error counts: the mean of Y's bands over its own mean over all area, so that 1 is usual; all 1
/// where nothing is seen.
PatchField<double> importance_weights(const RadiositySystem& system, const Importance& importance);

/// The estimate with η_i √w_i for η_i: Σ η² then weighs each square metre by how much it counts, as the mean square
/// over a picture's pixels does. For mark(); total and relative stay those of the whole scene.
ErrorEstimate weighted(const ErrorEstimate& error, const PatchField<double>& weights);

/// Weights carried to another mesh of the scene: each patch has that of the patch under its middle; 1 where there is
/// none.
PatchField<double> weights_on(const Scene& scene, const PatchMesh& mesh, const PatchLocator& locator,
                              const PatchField<double>& weights);

}  // namespace patchlight
