#include "solver/solve.h"

#include "formfactor/audit.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace patchlight {

namespace {

bool is_reciprocal(const RadiositySystem& system)
{
    return asymmetry(rows_of(system.F), system.area) <= reciprocal_enough;
}

}  // namespace

SolveReport solve(const RadiositySystem& system, Radiosity& B, const SolveOptions& options, const WorkMonitor& monitor)
{
    switch (options.solver) {
    case Solver::progressive:
        return solve_shooting(system, columns_of(system), B, options, monitor);
    case Solver::jacobi:
    case Solver::gauss_seidel:
        return solve_gathering(system, B, options, monitor);
    case Solver::conjugate_gradient:
        if (!is_reciprocal(system))
            throw std::invalid_argument("conjugate gradients need reciprocal form factors; take bicgstab");
        return solve_conjugate_gradient(system, rows_of(system.F), B, options, monitor);
    case Solver::bicgstab:
        return solve_bicgstab(system, rows_of(system.F), B, options, monitor);
    case Solver::hierarchical:
        throw std::invalid_argument("links need the mesh, not rows: solve_hierarchical()");
    }
    throw std::invalid_argument("no such solver");
}

void make_reciprocal(RadiositySystem& system, bool closed)
{
    if (is_reciprocal(system)) return;
    // Closed is what lamps shine into: what looks out of it keeps what escapes.
    const bool looks_out = std::ranges::any_of(system.F.escaped.values(), [](double share) { return share > 0; });
    repair_symmetrically(system.F, system.area, closed && !looks_out);
}

ColumnSource columns_of(const RadiositySystem& system)
{
    const bool reciprocal = is_reciprocal(system);
    // Of F^T's rows; shared, as a ColumnSource is copied.
    const auto turned =
        std::make_shared<const FormFactorMatrix>(reciprocal ? FormFactorMatrix{} : transposed(system.F));
    return [&system, turned, reciprocal](PatchId shooter, std::span<double> column) -> std::size_t {
        const FormFactorMatrix& rows = reciprocal ? system.F : *turned;
        std::ranges::fill(column, 0.0);
        for (std::size_t k = rows.row_start[shooter.value]; k < rows.row_start[shooter.value + 1]; ++k) {
            const PatchId j(rows.columns[k]);
            column[j.value] += reciprocal ? rows.factors[k] * system.area[shooter] / system.area[j] : rows.factors[k];
        }
        return 0;
    };
}

}  // namespace patchlight
