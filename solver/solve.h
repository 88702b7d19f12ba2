#pragma once

#include "solver/system.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

enum class Solver {
    progressive,
    jacobi,
    gauss_seidel,
    hierarchical  ///< links between groups of patches, see solve_hierarchical()
};

/// What is shot first.
enum class ShootingOrder {
    unshot_power,     ///< A_i ΔB_i, the usual choice
    unshot_radiosity  ///< ΔB_i, the lecture's
};

struct SolveOptions {
    Solver solver = Solver::gauss_seidel;
    double tolerance = 1e-4;  ///< on the bound Σ A|B − B̃| / Σ A B (worst band), > 0
    int max_sweeps = 200;     ///< sweeps, ≥ 1; a sweep of shooting is as many shots as there are patches
    ShootingOrder order = ShootingOrder::unshot_power;
    bool ambient = false;  ///< shooting: spread the unshot light as an ambient term over the result
};

/// How a linear solve went. Not converging is a report, not an exception.
struct SolveReport {
    Solver solver = Solver::gauss_seidel;
    std::size_t iterations = 0;  ///< sweeps, or shots
    double residual = 0;         ///< what `tolerance` is compared with, at the end
    double unshot = 0;           ///< share of the emitted power not yet shot; gathering: 0
    bool converged = false;
    std::size_t rays = 0;         ///< traced on demand
    std::size_t links = 0;        ///< hierarchical: that carry light, each both ways
    std::vector<double> history;  ///< residual after each sweep; shooting: after 1, 2, 4, 8 … shots
};

/// One row of Gauss–Seidel: B_i = E_i + ρ_i Σ_j F_ij B_j with the newest values. Returns the change.
Rgb gather_row(const RadiositySystem& system, Radiosity& B, PatchId i);

/// Gathers on the assembled rows from the start value in B until the last sweep's change, carried on for ever,
/// would alter Σ A B by less than the tolerance: Σ A|ΔB| ρmax/(1 − ρmax) ≤ tolerance · Σ A B, in each band.
/// Jacobi takes all values from the sweep before (the matrix the lecture shows as Gauss–Seidel is this one);
/// Gauss–Seidel takes the newest. Throws Interrupted.
SolveReport solve_gathering(const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                            const WorkMonitor& monitor = {});

/// Column i of F: F_ji for all j, into the span; returns the rays it took.
using ColumnSource = std::function<std::size_t(PatchId shooter, std::span<double> column)>;

/// Progressive radiosity: shoots from the patch with the most unshot light, B_j += ρ_j F_ji ΔB_i, columns computed
/// on demand and not stored, until ρmax · unshot power/(1 − ρmax) ≤ tolerance · Σ A B in each band (B holds
/// the unshot part already). B starts from E, whatever it held. `on_shot(report, B)` after each shot.
/// [CohenChenWallaceGreenberg88]. Throws Interrupted.
SolveReport solve_shooting(const RadiositySystem& system, const ColumnSource& column_of, Radiosity& B,
                           const SolveOptions& options, const WorkMonitor& monitor = {},
                           const std::function<void(const SolveReport&, const Radiosity&)>& on_shot = {});

}  // namespace patchlight
