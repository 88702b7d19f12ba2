#include "solver/adaptive.h"

#include "solver/hierarchical.h"

#include <chrono>

namespace patchlight {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What one solve left: how it went, where the light went, and the reconstruction.
struct Solved {
    SolveReport report;
    EnergyBalance energy;
    VertexRadiosity vertex_B;
    MidpointRadiosity middle_B;
};

SolveReport shoot(const Exchange& exchange, const RadiositySystem& system, Radiosity& B, const SolveOptions& options,
                  const FormFactorOptions& sampling, const WorkMonitor& monitor)
{
    const RowSampler sampler(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, emitters(exchange.scene),
                             sampling);
    const ColumnSource column_of = [&](PatchId shooter, std::span<double> column) {
        return sampler.shooter_column(shooter, column, {monitor.stop, {}});
    };
    return solve_shooting(system, column_of, B, options, monitor);
}

/// From B to its reflected part, which starts from what direct light leaves: R = ρ H_direct + ρ F R.
void take_direct_light(RadiositySystem& system, Radiosity& B)
{
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        B[p] -= system.E[p];
        system.E[p] = system.rho[p] * system.direct[p];
    }
}

void add(const Radiosity& more, Radiosity& B)
{
    for (std::size_t i = 0; i < B.size(); ++i) B[PatchId(i)] += more[PatchId(i)];
}

/// The stages of one cycle on one mesh: runs, times and reports each.
class Cycle {
    template <class Work>
    auto stage(std::string_view name, double& spent, const Work& work)
    {
        if (observers_.stop.stop_requested()) throw Interrupted();
        WorkMonitor monitor{observers_.stop, {}};
        Progress progress{name, number_, 0, exchange_.mesh.patch_count()};
        if (observers_.on_progress)
            monitor.tell = [this, progress](const WorkState& state) mutable {
                progress.fraction = state.fraction;
                progress.rays = state.rays;
                progress.unshot = state.unshot;
                observers_.on_progress(progress);
            };
        if (monitor.tell) monitor.tell({});
        const auto begin = Clock::now();
        auto result = work(monitor);
        spent += seconds_since(begin);
        return result;
    }

public:
    Cycle(const Scene& scene, const RayCaster& caster, const DirectLight* direct, const PatchMesh& mesh, int number,
          const AdaptiveOptions& options, const AdaptiveObservers& observers)
        : locator_(mesh), exchange_{scene, caster, mesh, locator_, direct}, number_(number), options_(options),
          observers_(observers)
    {}

    /// First shooting on the coarse mesh; later gathering a little, from what the coarser mesh knew.
    Solved solve_roughly(Radiosity& B)
    {
        FormFactorOptions coarse = options_.form_factors;
        coarse.rays = std::max(64, coarse.rays / 4);
        return number_ == 0 ? solve(B, options_.rough, coarse)
                            : solve(B, {.solver = Solver::gauss_seidel, .tolerance = 0.02}, coarse);
    }

    /// The final solve: all rays, the tight tolerance, light gathered at the elements' nodes.
    Solved solve_tightly(Radiosity& B)
    {
        Solved solved = solve(B, options_.final, options_.form_factors);
        Reconstruction nodes = stage("gather", seconds.gather, [&](const WorkMonitor& monitor) {
            return reconstruct(exchange_, B, options_.gather, monitor, options_.elements);
        });
        rays += nodes.rays;
        solved.vertex_B = std::move(nodes.B);
        solved.middle_B = std::move(nodes.middle_B);
        return solved;
    }

    Evaluation evaluate(const Radiosity& B)
    {
        return stage("estimate", seconds.estimate, [&](const WorkMonitor& monitor) {
            Evaluation evaluation = patchlight::evaluate(exchange_, B, options_.estimate, options_.gather, monitor);
            rays += evaluation.rays;
            return evaluation;
        });
    }

    Refinement refine(const RefinementPlan& plan)
    {
        MeshingOptions meshing = options_.meshing;
        meshing.max_elements = options_.max_elements;
        return stage("mesh", seconds.mesh, [&](const WorkMonitor&) {
            return options_.refine == Refine::discontinuity
                       ? remesh(exchange_.scene, exchange_.mesh, plan.lines, meshing)
                       : patchlight::refine(exchange_.scene, exchange_.mesh, plan, meshing);
        });
    }

    StageSeconds seconds;
    std::size_t rays = 0;

private:
    Solved solve_on_links(Radiosity& B, const SolveOptions& options, std::uint64_t seed)
    {
        const RadiositySystem system =
            stage("assemble", seconds.assemble, [&](const WorkMonitor&) { return unassembled(exchange_); });
        const HierarchicalSolution found = stage("solve", seconds.solve, [&](const WorkMonitor& monitor) {
            return solve_hierarchical(exchange_, system, B, {.tolerance = options.tolerance, .seed = seed}, monitor);
        });
        rays += found.rays;
        return {found.report, found.energy, {}, {}};
    }

    Solved solve(Radiosity& B, const SolveOptions& options, const FormFactorOptions& sampling)
    {
        if (options.solver == Solver::hierarchical) return solve_on_links(B, options, sampling.seed);
        const bool shooting = options.solver == Solver::progressive;
        // Shooting computes columns on demand; the tight solve assembles all the same, for the energy balance.
        const bool rows = !shooting || &options == &options_.final;
        RadiositySystem system = stage("assemble", seconds.assemble, [&](const WorkMonitor& monitor) {
            return rows ? assemble(exchange_, sampling, monitor) : unassembled(exchange_);
        });
        Solved solved;
        const Radiosity emission = system.E;
        if (exchange_.direct) take_direct_light(system, B);
        solved.report = stage("solve", seconds.solve, [&](const WorkMonitor& monitor) {
            return shooting ? shoot(exchange_, system, B, options, sampling, monitor)
                            : solve_gathering(system, B, options, monitor);
        });
        if (exchange_.direct) {
            add(emission, B);
            system.E = emission;
        }
        if (rows) solved.energy = energy_balance(system, B);
        rays += system.F.rays + solved.report.rays;
        return solved;
    }

    PatchLocator locator_;
    Exchange exchange_;
    int number_;
    const AdaptiveOptions& options_;
    const AdaptiveObservers& observers_;
};

/// The uniform mesh to begin with. An automatic one leaves three quarters of the budget to refinement.
PatchMesh first_mesh(const Scene& scene, const AdaptiveOptions& options)
{
    PatchMesh mesh = triangulate(scene, options.meshing);
    const bool automatic = options.meshing.max_edge <= 0 && options.meshing.max_elements == 0;
    if (options.refine == Refine::none || !automatic || 4 * mesh.patch_count() <= options.max_elements) return mesh;
    MeshingOptions coarser = options.meshing;
    coarser.max_elements = options.max_elements / 4;
    mesh = triangulate(scene, coarser);
    // Long narrow surfaces take most of a small budget for their angles' sake: then the budget comes first.
    if (4 * mesh.patch_count() <= options.max_elements) return mesh;
    coarser.min_angle = 0;
    return triangulate(scene, coarser);
}

bool finished(const PatchMesh& mesh, const ErrorEstimate& error, const RefinementPlan& plan, int cycle,
              const AdaptiveOptions& options)
{
    const bool good = options.target_error > 0 && error.relative <= options.target_error;
    // Within a fiftieth of the budget a further cycle would cost more than it buys.
    const bool full = options.max_elements > 0 && 50 * mesh.patch_count() >= 49 * options.max_elements;
    const bool lined = options.refine == Refine::discontinuity && !mesh.lines().empty();
    return options.refine == Refine::none || good || full || lined || plan.empty() || cycle >= options.iterations;
}

Stage stage_of(int cycle, bool last, const AdaptiveOptions& options)
{
    if (options.refine == Refine::none) return Stage::uniform;
    if (last) return Stage::final;
    return cycle == 0 ? Stage::rough : Stage::adaptive;
}

bool uses_lines(const AdaptiveOptions& options)
{
    return options.refine == Refine::discontinuity || options.refine == Refine::both;
}

/// The emitters' light, as far as it is asked for, and where it breaks off. Depends on the scene alone.
struct Emitted {
    Emitted(const Scene& scene, const AdaptiveOptions& options, const AdaptiveObservers& observers)
    {
        const WorkMonitor monitor{observers.stop, {}};
        if (options.direct == Direct::exact || uses_lines(options)) exact = emitters_light(scene, monitor);
        if (observers.on_progress && uses_lines(options)) observers.on_progress({.stage = "lines"});
        if (uses_lines(options)) lines = discontinuities(scene, light(), options.lines, monitor);
    }
    const DirectLight* light() const { return exact ? &*exact : nullptr; }

    std::optional<DirectLight> exact;
    std::vector<Discontinuity> lines;
};

RefinementPlan plan_next(const Scene& scene, const PatchMesh& mesh, const ErrorEstimate& error,
                         std::span<const Discontinuity> lines, const AdaptiveOptions& options)
{
    RefinementPlan plan;
    if (options.refine == Refine::intensity || options.refine == Refine::both)
        plan = mark(scene, mesh, error, options.mark);
    if (uses_lines(options))
        plan.lines =
            worthwhile_lines(scene, mesh, error, lines, options.max_elements, options.target_error, options.lines);
    return plan;
}

}  // namespace

AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers, std::optional<AdaptiveStart> start)
{
    const RayCaster caster(scene);
    const auto begin = Clock::now();
    const Emitted emitted(scene, options, observers);
    const DirectLight* direct = options.direct == Direct::exact ? emitted.light() : nullptr;
    const std::vector<Discontinuity>& lines = emitted.lines;
    PatchMesh mesh = start ? std::move(start->mesh) : first_mesh(scene, options);
    Radiosity B = start ? std::move(start->B) : emittance(scene, mesh);
    double meshing = seconds_since(begin);  // of the mesh that the next cycle works on

    for (int cycle = start ? start->cycle : 0;; ++cycle) {
        Cycle work(scene, caster, direct, mesh, cycle, options, observers);
        work.seconds.mesh = meshing;
        RefinementPlan plan;
        if (start) {  // this cycle was observed by the run that is continued
            plan = plan_next(scene, mesh, start->error, lines, options);
            start.reset();
        } else {
            Solved solved = options.refine == Refine::none ? work.solve_tightly(B) : work.solve_roughly(B);
            Evaluation evaluation = work.evaluate(B);
            plan = plan_next(scene, mesh, evaluation.error, lines, options);
            const bool last = finished(mesh, evaluation.error, plan, cycle, options);
            if (last && options.refine != Refine::none) solved = work.solve_tightly(B);

            const VertexRadiosity& vertex_B = last ? solved.vertex_B : evaluation.vertex_B;
            if (observers.on_step)
                observers.on_step({cycle, stage_of(cycle, last, options), mesh, B, vertex_B, solved.middle_B,
                                   solved.report, evaluation.error, solved.energy,
                                   last ? 0 : plan.bisections.size() + plan.lines.size(),
                                   count_lines(scene, mesh, lines), work.rays, work.seconds});
            if (last) {
                const bool met = options.target_error <= 0 || evaluation.error.relative <= options.target_error;
                return {std::move(mesh),
                        std::move(B),
                        std::move(solved.vertex_B),
                        std::move(solved.middle_B),
                        std::move(evaluation.error),
                        solved.energy,
                        solved.report,
                        solved.report.converged && met};
            }
        }
        work.seconds.mesh = 0;
        Refinement refined = work.refine(plan);
        meshing = work.seconds.mesh;
        B = prolong(refined.mesh, B, refined.transfer);
        mesh = std::move(refined.mesh);
    }
}

}  // namespace patchlight
