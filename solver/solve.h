#pragma once

#include "solver/light_operator.h"
#include "solver/system.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

enum class Solver {
    progressive,         ///< Southwell: shoots from the patch with the most unshot light
    jacobi,              ///< gathers; all values from the sweep before (what the lecture shows as Gauss–Seidel)
    gauss_seidel,        ///< gathers; the newest values
    conjugate_gradient,  ///< the fewest products with F; reciprocal factors only
    bicgstab,            ///< the same for factors that aren't reciprocal; two products an iteration
    hierarchical         ///< links between groups of patches, see solve_hierarchical()
};

/// What is shot first.
enum class ShootingOrder {
    unshot_power,     ///< A_i ΔB_i, the usual choice
    unshot_radiosity  ///< ΔB_i, the lecture's
};

struct SolveOptions {
    Solver solver = Solver::gauss_seidel;
    double tolerance = 1e-4;  ///< on the bound Σ A|B − B̃| / Σ A B (worst band), > 0
    int max_sweeps = 200;  ///< sweeps or iterations, ≥ 1; a sweep of shooting is as many shots as there are patches
    ShootingOrder order = ShootingOrder::unshot_power;
    bool ambient = false;    ///< shooting: spread the unshot light as an ambient term over the result
    bool overshoot = false;  ///< shooting: with what the ambient light will still bring the shooter
};

/// How a linear solve went. Not converging is a report, not an exception.
struct SolveReport {
    Solver solver = Solver::gauss_seidel;
    std::size_t iterations = 0;  ///< sweeps, iterations or shots
    double residual = 0;         ///< what `tolerance` is compared with, at the end
    double unshot = 0;           ///< share of the emitted power not yet shot; gathering: 0
    bool converged = false;
    std::size_t rays = 0;         ///< traced on demand
    std::size_t links = 0;        ///< hierarchical: that carry light, each both ways
    std::vector<double> history;  ///< residual after each sweep or iteration; shooting: after 1, 2, 4, 8 … shots
};

/// Solves an assembled system by options.solver, from the start value in B (progressive: from E). Throws
/// std::invalid_argument for conjugate gradients on rows that aren't reciprocal (make_reciprocal()) and for
/// hierarchical, and Interrupted.
SolveReport solve(const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                  const WorkMonitor& monitor = {});

/// Makes sampled rows reciprocal, and closed in a closed scene of which no patch looks out (repair_symmetrically());
/// others stay as they are.
void make_reciprocal(RadiositySystem& system, bool closed);

/// Jacobi or Gauss–Seidel on the assembled rows from the start value in B until the last sweep's change, carried on for
/// ever, would alter Σ A B by less than the tolerance: Σ A|ΔB| ρmax/(1 − ρmax) ≤ tolerance · Σ A B, in each band.
/// Gauss–Seidel takes the newest values block by block, at most 64 blocks of consecutive patches, whatever the number
/// of threads; patches of one plane don't see each other, so that it takes the sweeps it would take row by row, or
/// hardly more. Throws Interrupted.
SolveReport solve_gathering(const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                            const WorkMonitor& monitor = {});

/// Conjugate gradients on (I − √ρ S √ρ) x = √ρ S √A E with S = A^½ F A^-½ and x = √A (B − E)/√ρ, each band for itself
/// but all in one product with F an iteration; where ρ = 0, B = E. From the start value in B until
/// Σ A|E + ρFB − B|/(1 − ρmax), which bounds Σ A|B − B̃|, is below tolerance · Σ A B in each band. Only for operators
/// with A_i F_ij = A_j F_ji: what it answers for others is wrong, unnoticed (asymmetry() tells). Needs areas, E and ρ
/// of `system`, not its F. What is left below E is raised to E. [HestenesStiefel52]. Throws Interrupted.
SolveReport solve_conjugate_gradient(const RadiositySystem& system, const LightOperator& F, Radiosity& B,
                                     const SolveOptions& options, const WorkMonitor& monitor = {});

/// The same for operators that needn't be reciprocal, with two products an iteration; for sampled rows, whose columns
/// need not sum to 1, the bound is off by their noise. [VanDerVorst92]. Throws Interrupted.
SolveReport solve_bicgstab(const RadiositySystem& system, const LightOperator& F, Radiosity& B,
                           const SolveOptions& options, const WorkMonitor& monitor = {});

/// Column i of F: F_ji for all j, into the span; returns the rays it took.
using ColumnSource = std::function<std::size_t(PatchId shooter, std::span<double> column)>;

/// The columns of the assembled rows; rows that aren't reciprocal are transposed once. Keeps a reference to the system.
ColumnSource columns_of(const RadiositySystem& system);

/// Progressive radiosity: shoots from the patch with the most unshot light, B_j += ρ_j F_ji ΔB_i, columns computed
/// on demand and not stored, until ρmax · unshot power/(1 − ρmax) ≤ tolerance · Σ A B in each band (B holds
/// the unshot part already). B starts from E, whatever it held. `on_shot(report, B)` after each shot.
/// [CohenChenWallaceGreenberg88]. Overshooting sends ρ_i times the ambient light along, which is then owed: unshot
/// light may be negative, and the bound takes its absolute value [FedaPurgathofer92]. Throws Interrupted.
SolveReport solve_shooting(const RadiositySystem& system, const ColumnSource& column_of, Radiosity& B,
                           const SolveOptions& options, const WorkMonitor& monitor = {},
                           const std::function<void(const SolveReport&, const Radiosity&)>& on_shot = {});

}  // namespace patchlight
