#include "solver/adaptive.h"

#include <chrono>

namespace patchlight {

namespace {

using Clock = std::chrono::steady_clock;

/// Runs a stage, adds its wall time to `seconds`, and passes its progress on.
template <class Work>
auto timed(double& seconds, const AdaptiveObservers& observers, Progress progress, const Work& work)
{
    if (observers.stop.stop_requested()) throw Interrupted();
    WorkMonitor monitor{observers.stop, {}};
    if (observers.on_progress) {
        observers.on_progress(progress);
        monitor.tell = [&](double fraction) {
            progress.fraction = fraction;
            observers.on_progress(progress);
        };
    }
    const auto begin = Clock::now();
    auto result = work(monitor);
    seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    return result;
}

/// Shooting computes columns on demand; gathering assembles all rows.
SolveReport shoot(const Exchange& exchange, const RadiositySystem& system, Radiosity& B, const AdaptiveOptions& options,
                  const SolveOptions& solver, const WorkMonitor& monitor)
{
    const RowSampler sampler(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, emitters(exchange.scene),
                             options.form_factors);
    const ColumnSource column_of = [&](PatchId shooter, std::span<double> column) {
        return sampler.shooter_column(shooter, column, {monitor.stop, {}});
    };
    return solve_shooting(system, column_of, B, solver, monitor);
}

bool finished(const PatchMesh& mesh, const ErrorEstimate& error, const RefinementPlan& plan, int cycle,
              const AdaptiveOptions& options)
{
    const bool good = options.target_error > 0 && error.relative <= options.target_error;
    // Within a fiftieth of the budget a further cycle would cost more than it buys.
    const bool full = options.max_elements > 0 && 50 * mesh.patch_count() >= 49 * options.max_elements;
    return good || full || plan.empty() || options.refine == Refine::none || cycle >= options.iterations;
}

Stage stage_of(int cycle, bool last, const AdaptiveOptions& options)
{
    if (options.refine == Refine::none) return Stage::uniform;
    if (last) return Stage::final;
    return cycle == 0 ? Stage::rough : Stage::adaptive;
}

}  // namespace

AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options, const AdaptiveObservers& observers,
                                  std::optional<AdaptiveStart> start)
{
    const RayCaster caster(scene);
    StageSeconds seconds;
    MeshingOptions refining = options.meshing;
    refining.max_elements = options.max_elements;
    int cycle = start ? start->cycle : 0;
    PatchMesh mesh = start ? std::move(start->mesh) : timed(seconds.mesh, observers, {"mesh"}, [&](const WorkMonitor&) {
        return triangulate(scene, options.meshing);
    });
    Radiosity B = start ? std::move(start->B) : emittance(scene, mesh);
    std::optional<ErrorEstimate> known = start ? std::optional(std::move(start->error)) : std::nullopt;

    for (;; ++cycle) {
        if (!known) {
            const PatchLocator locator(mesh);
            const Exchange exchange{scene, caster, mesh, locator};
            const auto progress = [&](std::string_view stage) { return Progress{stage, cycle, 0, mesh.patch_count()}; };
            const bool rough = cycle == 0 && options.refine != Refine::none;
            const SolveOptions& solver = rough ? options.rough : options.final;

            const RadiositySystem system = timed(seconds.assemble, observers, progress("assemble"), [&](const auto& monitor) {
                return rough ? unassembled(scene, mesh) : assemble(exchange, options.form_factors, monitor);
            });
            SolveReport solved = timed(seconds.solve, observers, progress("solve"), [&](const auto& monitor) {
                return solver.solver == Solver::progressive ? shoot(exchange, system, B, options, solver, monitor)
                                                            : solve_gathering(system, B, solver, monitor);
            });
            Reconstruction linear = timed(seconds.gather, observers, progress("gather"), [&](const auto& monitor) {
                return reconstruct(exchange, B, options.gather, monitor);
            });
            ErrorEstimate error = timed(seconds.estimate, observers, progress("estimate"), [&](const auto& monitor) {
                return estimate(exchange, B, linear.B, options.estimate, options.gather, monitor);
            });
            const EnergyBalance energy = rough ? EnergyBalance{} : energy_balance(system, B);
            const RefinementPlan plan = mark(scene, mesh, error, options.mark);
            const bool last = finished(mesh, error, plan, cycle, options);
            if (observers.on_step)
                observers.on_step({cycle, stage_of(cycle, last, options), mesh, B, linear.B, solved, error, energy,
                                   last ? 0 : plan.splits.size(),
                                   system.F.rays + solved.rays + linear.rays + error.rays, seconds});
            if (last) {
                const bool met = options.target_error <= 0 || error.relative <= options.target_error;
                const bool converged = solved.converged && met;
                return {std::move(mesh), std::move(B), std::move(linear.B), std::move(error), energy, std::move(solved),
                        converged};
            }
            known = std::move(error);
        }
        seconds = {};
        Refinement refined = timed(seconds.mesh, observers, {"mesh", cycle, 0, mesh.patch_count()}, [&](const auto&) {
            return refine(scene, mesh, mark(scene, mesh, *known, options.mark), refining);
        });
        B = prolong(refined.mesh, B, refined.transfer);
        mesh = std::move(refined.mesh);
        known.reset();
    }
}

}  // namespace patchlight
