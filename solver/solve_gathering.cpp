#include "solver/solve.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace patchlight {

namespace {

constexpr std::size_t most_blocks = 64;
/// Entries of a block below which threads cost more than they bring.
constexpr std::size_t worth_threads = 50'000;

/// What a sweep changed, and what there is: Σ A|ΔB| and Σ A B.
struct Sweep {
    Rgb change{0.0}, total{0.0};
};

/// Gathers patches [first, last) from B as it is, then puts the new values into it; `light` is B, too.
void gather_block(const RadiositySystem& system, Radiosity& B, LightLanes& light, std::size_t first, std::size_t last,
                  std::vector<Rgb>& fresh, Sweep& sweep)
{
    const auto gather = [&](std::size_t i) {
        fresh[i - first] = system.E[PatchId(i)] + system.rho[PatchId(i)] * gathered(system.F, light, i);
    };
    if (system.F.row_start[last] - system.F.row_start[first] >= worth_threads)
        tbb::parallel_for(first, last, gather);
    else
        for (std::size_t i = first; i < last; ++i) gather(i);
    for (std::size_t i = first; i < last; ++i) {
        const PatchId p(i);
        sweep.change += system.area[p] * glm::abs(fresh[i - first] - B[p]);
        sweep.total += system.area[p] * fresh[i - first];
        B[p] = fresh[i - first];
        light.set(p, B[p]);
    }
}

}  // namespace

SolveReport solve_gathering(const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                            const WorkMonitor& monitor)
{
    SolveReport report;
    report.solver = options.solver;
    Rgb rho_max(0.0);
    for (const Rgb& rho : system.rho.values()) rho_max = glm::max(rho_max, rho);
    // Jacobi is one block.
    const std::size_t n = B.size(), blocks = options.solver == Solver::jacobi ? 1 : std::min(n, most_blocks);
    LightLanes light(B);
    std::vector<Rgb> fresh(n / std::max<std::size_t>(1, blocks) + 1);
    while (report.iterations < static_cast<std::size_t>(options.max_sweeps) && !report.converged) {
        Sweep sweep;
        for (std::size_t b = 0; b < blocks; ++b) {
            if (monitor.stop.stop_requested()) throw Interrupted();
            gather_block(system, B, light, b * n / blocks, (b + 1) * n / blocks, fresh, sweep);
        }
        ++report.iterations;
        report.residual = 0;
        for (int band = 0; band < 3; ++band)
            if (sweep.total[band] > 0)
                report.residual = std::max(report.residual, sweep.change[band] * rho_max[band] / (1 - rho_max[band]) /
                                                                sweep.total[band]);
        report.history.push_back(report.residual);
        report.converged = report.residual <= options.tolerance;
        // The logarithm of the way down is about linear in sweeps.
        if (monitor.tell)
            monitor.tell({.fraction = std::clamp(std::log(report.residual) / std::log(options.tolerance), 0.0, 1.0),
                          .residual = report.residual});
    }
    return report;
}

}  // namespace patchlight
