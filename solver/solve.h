#pragma once

#include "solver/system.h"

#include <string>
#include <vector>

namespace patchlight {

enum class Solver { progressive, jacobi, gauss_seidel };

/// What is shot first.
enum class ShootingOrder {
    unshot_power,  ///< A_i ΔB_i, the usual choice
    unshot_radiosity  ///< ΔB_i, the lecture's
};

struct SolveOptions {
    Solver solver = Solver::gauss_seidel;
    double tolerance = 1e-4;   ///< progressive: bound on Σ A|B − B̃| / Σ A B; gathering: largest relative change in a sweep
    int max_sweeps = 200;      ///< sweeps; a sweep of shooting is as many shots as there are patches
    ShootingOrder order = ShootingOrder::unshot_power;
};

/// How a linear solve went. Not converging is a report, not an exception.
struct SolveReport {
    Solver solver = Solver::gauss_seidel;
    std::size_t iterations = 0;    ///< sweeps, or shots
    double residual = 0;           ///< what `tolerance` is compared with, at the end
    double unshot = 0;             ///< share of the emitted power not yet shot; gathering: 0
    bool converged = false;
    std::vector<double> history;   ///< residual after each sweep (shooting: after 1, 2, 4, 8 … shots)
};

}  // namespace patchlight
