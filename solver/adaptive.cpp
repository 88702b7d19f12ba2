#include "solver/adaptive.h"

#include "solver/importance.h"

#include <algorithm>
#include <chrono>
#include <tbb/parallel_for.h>
#include <utility>

namespace patchlight {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs the stages of a cycle: tells the observers, adds up the seconds.
class Stages {
public:
    explicit Stages(const AdaptiveObservers& observers) : observers_(observers) {}

    template <class Work>
    auto run(std::string_view name, double StageSeconds::*spent, std::size_t elements, const Work& work)
    {
        if (observers_.stop.stop_requested()) throw Interrupted();
        WorkMonitor monitor{observers_.stop, {}};
        Progress progress{name, cycle, 0, elements};
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
        seconds.*spent += seconds_since(begin);
        return result;
    }

    int cycle = 0;
    StageSeconds seconds;

private:
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
        if (uses_lines(options)) lines = discontinuities(scene, exact ? &*exact : nullptr, options.lines, monitor);
        used = options.direct == Direct::exact && exact ? &*exact : nullptr;
        if (options.direct == Direct::sampled)
            for (const SurfaceId s : emitters(scene)) light.sources.emplace_back(scene, s);
    }

    std::optional<DirectLight> exact;
    const DirectLight* used = nullptr;  ///< null: sampled
    EmittedLight light;
    std::vector<Discontinuity> lines;
};

/// The patches of one mesh, solved.
struct PatchSolution {
    RadiositySystem system;
    Radiosity B;
    SolveReport report;
    std::size_t rays = 0;
};

/// Solves (I − diag(ρ)F)B = E with all bounces. Where the emitters' light is known exactly, for the reflected part:
/// R = ρ H_direct + ρ F R.
PatchSolution solve_patches(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages)
{
    PatchSolution solution;
    const std::size_t n = exchange.mesh.patch_count();
    solution.system = stages.run("assemble", &StageSeconds::assemble, n, [&](const WorkMonitor& monitor) {
        RadiositySystem made = assemble(exchange, options.form_factors, monitor);
        if (options.final.solver == Solver::conjugate_gradient) make_reciprocal(made, exchange.scene.closed);
        return made;
    });
    RadiositySystem& system = solution.system;
    const Radiosity emission = system.E;
    solution.B = emission;
    if (exchange.direct)
        for (std::size_t i = 0; i < n; ++i) {
            const PatchId p(i);
            solution.B[p] = Rgb(0.0);
            system.E[p] = system.rho[p] * system.direct[p];
        }
    solution.report = stages.run("solve", &StageSeconds::solve, n, [&](const WorkMonitor& monitor) {
        return solve(system, solution.B, options.final, monitor);
    });
    if (exchange.direct) {
        system.E = emission;
        for (std::size_t i = 0; i < n; ++i) solution.B[PatchId(i)] += emission[PatchId(i)];
    }
    solution.rays = system.F.rays + solution.report.rays;
    return solution;
}

/// The emitters' light found anew at each point, and the indirect light there.
LightAtPoints light_of(const Exchange& exchange, const EmittedLight& emitted, const IndirectLight& indirect,
                       const GatherOptions& options)
{
    return [&](std::span<const SurfacePoint> points, const WorkMonitor& monitor) {
        GatheredLight found = emitted.at(exchange, points, options, monitor);
        tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
            if (exchange.scene.material_of(points[i].surface).reflects())
                found.irradiance[i] += indirect.at(exchange.scene, points[i]);
        });
        return found;
    };
}

IndirectOptions indirect_options(const AdaptiveOptions& options)
{
    return {.target_error = options.target_error,
            .max_elements = options.max_elements,
            .rays = options.gather.rays,
            .rough_rays = options.estimate.rays,
            .directions = options.form_factors.directions,
            .gather = options.gather,
            .mark = {}};
}

bool finished(const PatchMesh& mesh, const ErrorEstimate& error, const RefinementPlan& plan, int cycle,
              const AdaptiveOptions& options)
{
    // Contacts that aren't in the first mesh yet are wrong whatever the estimate of the whole says.
    const bool contacts =
        cycle == 0 && std::ranges::any_of(plan.lines, [](const SurfaceLine& l) { return l.kind == LineKind::contact; });
    const bool good = options.target_error > 0 && error.relative <= options.target_error && !contacts;
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

/// How much the patches of the uniform mesh count for what is looked at; empty: all alike.
PatchField<double> weights_of(const Exchange& coarse, const RadiositySystem& system, const AdaptiveOptions& options)
{
    if (options.looked_at.empty()) return {};
    std::vector<PatchId> seen;
    for (const SurfacePoint& point : options.looked_at) {
        const Vec2 q = coarse.scene.surface(point.surface).frame.to_plane(point.position);
        seen.push_back(coarse.locator.locate(point.surface, static_cast<float>(q.x), static_cast<float>(q.y)));
    }
    const PatchField<double> shares = seen_shares(coarse.mesh.patch_count(), seen);
    return importance_weights(system, importance(system, rows_of(system.F), shares));
}

RefinementPlan plan_next(const Scene& scene, const PatchMesh& mesh, const Radiosity& B, const ErrorEstimate& error,
                         const PatchField<double>& weights, std::span<const Discontinuity> lines,
                         const AdaptiveOptions& options)
{
    RefinementPlan plan;
    if (options.refine == Refine::intensity || options.refine == Refine::both)
        plan = mark(scene, mesh, B, weights.empty() ? error : weighted(error, weights), options.mark);
    if (uses_lines(options))
        plan.lines =
            worthwhile_lines(scene, mesh, error, lines, options.max_elements, options.target_error, options.lines);
    return plan;
}

PatchMesh next_mesh(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan,
                    const AdaptiveOptions& options)
{
    MeshingOptions meshing = options.meshing;
    meshing.max_elements = options.max_elements;
    return options.refine == Refine::discontinuity ? triangulate(scene, meshing, plan.lines)
                                                   : refined(scene, mesh, plan, meshing);
}

}  // namespace

AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers, std::optional<AdaptiveStart> start)
{
    const RayCaster caster(scene);
    Stages stages(observers);
    const auto begin = Clock::now();
    const Emitted emitted(scene, options, observers);
    const PatchMesh uniform = first_mesh(scene, options);
    const PatchLocator uniform_locator(uniform);
    const Exchange coarse{scene, caster, uniform, uniform_locator, emitted.used};
    stages.seconds.mesh = seconds_since(begin);
    const PatchSolution patches = solve_patches(coarse, options, stages);
    std::size_t rays = patches.rays;
    const PatchField<double> weights = weights_of(coarse, patches.system, options);

    // What lights the nodes of a mesh: emitters and indirect light, or, on the uniform mesh alone, rays to its patches.
    std::optional<IndirectLight> indirect;
    if (options.refine != Refine::none) {
        indirect =
            stages.run("indirect", &StageSeconds::gather, uniform.patch_count(), [&](const WorkMonitor& monitor) {
                return solve_indirect({coarse, patches.system, patches.B, weights.empty() ? nullptr : &weights},
                                      emitted.light, indirect_options(options), monitor);
            });
        rays += indirect->rays;
    }

    PatchMesh mesh = start ? std::move(start->mesh) : PatchMesh(scene, uniform.arrays());
    for (int cycle = start ? start->cycle : 0;; ++cycle) {
        stages.cycle = cycle;
        const PatchLocator locator(mesh);
        const Exchange exchange{scene, caster, mesh, locator, emitted.used};
        const auto lit_with = [&](int gather_rays) -> LightAtPoints {
            if (indirect) return light_of(exchange, emitted.light, *indirect, options.gather);
            GatherOptions gather = options.gather;
            gather.rays = gather_rays;
            return light_from_patches(coarse, patches.B, gather);
        };
        const PatchField<double> counts = weights.empty() ? weights : weights_on(scene, mesh, uniform_locator, weights);
        RefinementPlan plan;
        if (start) {  // this cycle was observed by the run that is continued
            plan = plan_next(scene, mesh, start->B, start->error, counts, emitted.lines, options);
            start.reset();
        } else {
            Evaluation evaluation =
                stages.run("estimate", &StageSeconds::estimate, mesh.patch_count(), [&](const WorkMonitor& monitor) {
                    return evaluate(exchange, lit_with(options.estimate.rays), options.estimate.indicator,
                                    options.gather.crease_angle, indirect ? indirect->error() : 0, monitor);
                });
            rays += evaluation.rays;
            Radiosity B = cycle == 0 ? patches.B : patch_means(mesh, evaluation.vertex_B);
            plan = plan_next(scene, mesh, B, evaluation.error, counts, emitted.lines, options);
            const bool last = finished(mesh, evaluation.error, plan, cycle, options);
            Reconstruction nodes{std::move(evaluation.vertex_B), {}, 0};
            if (last && (!indirect || options.elements == Elements::quadratic)) {
                const int vertex_rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
                nodes =
                    stages.run("gather", &StageSeconds::gather, mesh.patch_count(), [&](const WorkMonitor& monitor) {
                        return reconstruct(exchange, lit_with(vertex_rays), options.gather.crease_angle, monitor,
                                           options.elements);
                    });
                rays += nodes.rays;
            }
            const EnergyBalance energy =
                cycle == 0 || !last
                    ? energy_balance(patches.system, patches.B)
                    : energy_balance(patches.system, prolong(uniform, B, overlap(mesh, locator, uniform)));
            if (observers.on_step)
                observers.on_step({cycle, stage_of(cycle, last, options), mesh, B, nodes.B, nodes.middle_B,
                                   patches.report, evaluation.error, energy,
                                   last ? 0 : plan.bisections.size() + plan.lines.size(),
                                   count_lines(scene, mesh, emitted.lines), std::exchange(rays, 0), stages.seconds});
            stages.seconds = {};
            if (last) {
                const bool met = options.target_error <= 0 || evaluation.error.relative <= options.target_error;
                return {std::move(mesh),
                        std::move(B),
                        std::move(nodes.B),
                        std::move(nodes.middle_B),
                        std::move(evaluation.error),
                        energy,
                        patches.report,
                        patches.report.converged && met};
            }
        }
        mesh = stages.run("mesh", &StageSeconds::mesh, mesh.patch_count(),
                          [&](const WorkMonitor&) { return next_mesh(scene, mesh, plan, options); });
    }
}

}  // namespace patchlight
