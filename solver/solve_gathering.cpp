#include "solver/solve.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

Rgb gathered(const RadiositySystem& system, const Radiosity& B, std::size_t i)
{
    const FormFactorMatrix& F = system.F;
    Rgb sum(0.0);
    for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) sum += F.factors[k] * B[PatchId(F.columns[k])];
    return system.E[PatchId(i)] + system.rho[PatchId(i)] * sum;
}

}  // namespace

Rgb gather_row(const RadiositySystem& system, Radiosity& B, PatchId i)
{
    const Rgb now = gathered(system, B, i.value);
    const Rgb change = now - B[i];
    B[i] = now;
    return change;
}

SolveReport solve_gathering(const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                            const WorkMonitor& monitor)
{
    SolveReport report;
    report.solver = options.solver;
    Rgb rho_max(0.0);
    for (const Rgb& rho : system.rho.values()) rho_max = glm::max(rho_max, rho);
    Radiosity before;
    while (report.iterations < static_cast<std::size_t>(options.max_sweeps) && !report.converged) {
        if (monitor.stop.stop_requested()) throw Interrupted();
        if (options.solver == Solver::jacobi) before = B;
        Rgb change(0.0), total(0.0);
        for (std::size_t i = 0; i < B.size(); ++i) {
            const PatchId p(i);
            Rgb delta;
            if (options.solver == Solver::jacobi) {
                B[p] = gathered(system, before, i);
                delta = B[p] - before[p];
            } else {
                delta = gather_row(system, B, p);
            }
            change += system.area[p] * glm::abs(delta);
            total += system.area[p] * B[p];
        }
        ++report.iterations;
        report.residual = 0;
        for (int band = 0; band < 3; ++band)
            if (total[band] > 0)
                report.residual =
                    std::max(report.residual, change[band] * rho_max[band] / (1 - rho_max[band]) / total[band]);
        report.history.push_back(report.residual);
        report.converged = report.residual <= options.tolerance;
        // The logarithm of the way down is about linear in sweeps.
        if (monitor.tell) monitor.tell({std::clamp(std::log(report.residual) / std::log(options.tolerance), 0.0, 1.0)});
    }
    return report;
}

}  // namespace patchlight
