#include "solver/adaptive.h"

#include "solver/hierarchical.h"
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
        progress_ = {name, cycle, 0, elements};
        rays_of_loop_ = 0;
        if (observers_.on_progress) monitor.tell = [this](const WorkState& state) { tell(state); };
        if (monitor.tell) monitor.tell({});
        const auto begin = Clock::now();
        auto result = work(monitor);
        seconds.*spent += seconds_since(begin);
        return result;
    }

    int cycle = 0;
    StageSeconds seconds;

private:
    /// A stage may be several loops, each of which counts its own rays.
    void tell(const WorkState& state)
    {
        progress_.fraction = std::max(progress_.fraction, state.fraction);
        progress_.rays += state.rays < rays_of_loop_ ? state.rays : state.rays - rays_of_loop_;
        rays_of_loop_ = state.rays;
        progress_.unshot = state.unshot;
        progress_.residual = state.residual;
        observers_.on_progress(progress_);
    }

    const AdaptiveObservers& observers_;
    Progress progress_;
    std::size_t rays_of_loop_ = 0;
};

/// The mesh that is given, or the uniform one to begin with. An automatic one leaves three quarters of the budget to
/// refinement.
PatchMesh first_mesh(const Scene& scene, const AdaptiveOptions& options)
{
    if (options.mesh) return PatchMesh(scene, *options.mesh);
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
    Emitted(const Scene& scene, const AdaptiveOptions& options, Stages& stages)
    {
        if (options.direct == Direct::exact || uses_lines(options))
            exact = stages.run("direct", &StageSeconds::mesh, 0,
                               [&](const WorkMonitor& monitor) { return emitters_light(scene, monitor); });
        if (uses_lines(options))
            lines = stages.run("lines", &StageSeconds::mesh, 0, [&](const WorkMonitor& monitor) {
                return discontinuities(scene, exact ? &*exact : nullptr, options.lines, monitor);
            });
        used = options.direct == Direct::exact && exact ? &*exact : nullptr;
        const std::vector<SurfaceId> sources = emitters(scene);
        if (options.direct == Direct::sampled && sources.size() <= RowSampler::most_sources)
            for (const SurfaceId s : sources) light.sources.emplace_back(scene, s);
    }

    std::optional<DirectLight> exact;
    const DirectLight* used = nullptr;  ///< null: sampled
    EmittedLight light;
    std::vector<Discontinuity> lines;
};

/// The patches of one mesh, solved.
struct PatchSolution {
    RadiositySystem system;  ///< without rows where links stood for them
    Radiosity B;
    SolveReport report;
    EnergyBalance energy;
    std::size_t rays = 0;
};

PatchSolution solve_on_links(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages)
{
    PatchSolution solution;
    const std::size_t n = exchange.mesh.patch_count();
    solution.system =
        stages.run("assemble", &StageSeconds::assemble, n, [&](const WorkMonitor&) { return unassembled(exchange); });
    solution.B = solution.system.E;
    const HierarchicalSolution found = stages.run("solve", &StageSeconds::solve, n, [&](const WorkMonitor& monitor) {
        const HierarchicalOptions links{.tolerance = options.final.tolerance, .seed = options.form_factors.seed};
        return solve_hierarchical(exchange, solution.system, solution.B, links, monitor);
    });
    solution.report = found.report;
    solution.energy = found.energy;
    solution.rays = found.rays;
    return solution;
}

/// Solves (I − diag(ρ)F)B = E with all bounces. Where the emitters' light is known exactly, for the reflected part:
/// R = ρ H_direct + ρ F R.
PatchSolution solve_patches(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages,
                            FormFactorMatrix* kept)
{
    if (options.final.solver == Solver::hierarchical) return solve_on_links(exchange, options, stages);
    PatchSolution solution;
    const std::size_t n = exchange.mesh.patch_count();
    solution.system = stages.run("assemble", &StageSeconds::assemble, n, [&](const WorkMonitor& monitor) {
        RadiositySystem made = assemble(exchange, options.form_factors, monitor, kept);
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
    solution.energy = energy_balance(system, solution.B);
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
            .directions = options.form_factors.directions,
            .gather = options.gather,
            // What it misses in dark places, light carries on from there.
            .mark = {.local = 0.5}};
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
PatchField<double> weights_of(const Exchange& coarse, const RadiositySystem& system, const AdaptiveOptions& options,
                              Stages& stages)
{
    if (options.looked_at.empty()) return {};
    std::vector<PatchId> seen;
    for (const SurfacePoint& point : options.looked_at) {
        const Vec2 q = coarse.scene.surface(point.surface).frame.to_plane(point.position);
        seen.push_back(coarse.locator.locate(point.surface, static_cast<float>(q.x), static_cast<float>(q.y)));
    }
    const PatchField<double> shares = seen_shares(coarse.mesh.patch_count(), seen);
    return stages.run("importance", &StageSeconds::solve, coarse.mesh.patch_count(), [&](const WorkMonitor& monitor) {
        const bool has_rows = system.F.size() > 0;
        const RadiositySystem assembled =
            has_rows ? RadiositySystem{} : assemble(coarse, options.form_factors, monitor);
        const RadiositySystem& rows = has_rows ? system : assembled;
        return importance_weights(rows, importance(rows, rows_of(rows.F), shares, {.tolerance = 0.01}, monitor));
    });
}

/// What to change; `counted` is the error as far as it counts for what is looked at.
RefinementPlan plan_next(const Scene& scene, const PatchMesh& mesh, const Radiosity& B, const ErrorEstimate& error,
                         const ErrorEstimate& counted, std::span<const Discontinuity> lines,
                         const AdaptiveOptions& options)
{
    RefinementPlan plan;
    if (options.refine == Refine::intensity || options.refine == Refine::both)
        plan = mark(scene, mesh, B, counted, options.mark);
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

/// What lights a mesh: the patches of the uniform mesh, solved, and what follows from them. Solved once, whatever the
/// cycles; depends on scene and options alone.
class Lighting {
public:
    Lighting(const Scene& scene, const RayCaster& caster, const Emitted& emitted, const AdaptiveOptions& options,
             Stages& stages, KeptRows* rows)
        : emitted_(emitted), options_(options), mesh_(first_mesh(scene, options)),
          locator_(mesh_), coarse_{scene, caster, mesh_, locator_, emitted.used},
          patches_(solve_patches(coarse_, options, stages, rows ? &rows->patches : nullptr)),
          weights_(weights_of(coarse_, patches_.system, options, stages))
    {
        if (options.refine == Refine::none) return;
        const RoughSolution rough{coarse_, patches_.system, patches_.B, weights_.empty() ? nullptr : &weights_};
        indirect_ = stages.run("indirect", &StageSeconds::gather, mesh_.patch_count(), [&](const WorkMonitor& monitor) {
            return solve_indirect(rough, emitted.light, indirect_options(options), monitor);
        });
    }

    const PatchMesh& uniform_mesh() const { return mesh_; }
    const PatchSolution& patches() const { return patches_; }
    std::size_t rays() const { return patches_.rays + (indirect_ ? indirect_->rays : 0); }
    double indirect_error() const { return indirect_ ? indirect_->error() : 0; }
    bool needs_gathering() const { return !indirect_; }

    /// The light at a mesh's nodes: the emitters' and the indirect; of the uniform mesh alone by rays to its patches.
    /// `kept`: its nodes' rows.
    LightAtPoints on(const Exchange& exchange, int gather_rays, FormFactorMatrix* kept) const
    {
        if (indirect_) return light_of(exchange, emitted_.light, *indirect_, options_.gather);
        GatherOptions gather = options_.gather;
        gather.rays = gather_rays;
        return light_from_patches(coarse_, patches_.B, gather, kept);
    }

    /// The error as far as it counts for what is looked at.
    ErrorEstimate counted(const PatchMesh& mesh, const ErrorEstimate& error) const
    {
        return weights_.empty() ? error : weighted(error, weights_on(coarse_.scene, mesh, locator_, weights_));
    }

    /// Where the light of a solution goes, by the rows of the uniform mesh; by links, where that of its patches does.
    EnergyBalance energy(const PatchMesh& mesh, const PatchLocator& locator, const Radiosity& B) const
    {
        if (patches_.system.F.size() == 0) return patches_.energy;
        return energy_balance(patches_.system, prolong(mesh_, B, overlap(mesh, locator, mesh_)));
    }
    EnergyBalance energy() const { return patches_.energy; }

private:
    const Emitted& emitted_;
    const AdaptiveOptions& options_;
    PatchMesh mesh_;
    PatchLocator locator_;
    Exchange coarse_;
    PatchSolution patches_;
    PatchField<double> weights_;
    std::optional<IndirectLight> indirect_;
};

/// The last mesh's nodes: on the uniform mesh with all rays, and for quadratic elements at the middles of edges, too.
Reconstruction final_nodes(const Exchange& exchange, const Lighting& lighting, Reconstruction found,
                           const AdaptiveOptions& options, Stages& stages, FormFactorMatrix* kept)
{
    if (!lighting.needs_gathering() && options.elements == Elements::linear) return found;
    const int rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
    return stages.run("gather", &StageSeconds::gather, exchange.mesh.patch_count(), [&](const WorkMonitor& monitor) {
        return reconstruct(exchange, lighting.on(exchange, rays, kept), options.gather.crease_angle, monitor,
                           options.elements);
    });
}

}  // namespace

AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers, std::optional<AdaptiveStart> start)
{
    const RayCaster caster(scene);
    Stages stages(observers);
    const Emitted emitted(scene, options, stages);
    KeptRows* kept = options.refine == Refine::none ? observers.rows : nullptr;
    const Lighting lighting(scene, caster, emitted, options, stages, kept);
    const SolveReport& solved = lighting.patches().report;
    // Of a run that is continued they are counted already.
    std::size_t rays = start ? 0 : lighting.rays();

    PatchMesh mesh = start ? std::move(start->mesh) : PatchMesh(scene, lighting.uniform_mesh().arrays());
    for (int cycle = start ? start->cycle : 0;; ++cycle) {
        stages.cycle = cycle;
        const PatchLocator locator(mesh);
        const Exchange exchange{scene, caster, mesh, locator, emitted.used};
        RefinementPlan plan;
        if (start) {  // this cycle was observed by the run that is continued
            plan = plan_next(scene, mesh, start->B, start->error, lighting.counted(mesh, start->error), emitted.lines,
                             options);
            start.reset();
        } else {
            Evaluation found =
                stages.run("estimate", &StageSeconds::estimate, mesh.patch_count(), [&](const WorkMonitor& monitor) {
                    return evaluate(
                        exchange, lighting.on(exchange, options.estimate.rays, kept ? &kept->estimate : nullptr),
                        options.estimate.indicator, options.gather.crease_angle, lighting.indirect_error(), monitor);
                });
            Radiosity B = cycle == 0 ? lighting.patches().B : patch_means(mesh, found.vertex_B);
            plan = plan_next(scene, mesh, B, found.error, lighting.counted(mesh, found.error), emitted.lines, options);
            const bool last = finished(mesh, found.error, plan, cycle, options);
            Reconstruction nodes{std::move(found.vertex_B), {}, 0};
            if (last)
                nodes =
                    final_nodes(exchange, lighting, std::move(nodes), options, stages, kept ? &kept->nodes : nullptr);
            rays += found.rays + nodes.rays;
            const EnergyBalance energy = last && cycle > 0 ? lighting.energy(mesh, locator, B) : lighting.energy();
            if (observers.on_step)
                observers.on_step({cycle, stage_of(cycle, last, options), mesh, B, nodes.B, nodes.middle_B, solved,
                                   found.error, energy, last ? 0 : plan.bisections.size() + plan.lines.size(),
                                   count_lines(scene, mesh, emitted.lines), std::exchange(rays, 0), stages.seconds});
            stages.seconds = {};
            if (last) {
                const bool met = options.target_error <= 0 || found.error.relative <= options.target_error;
                return {std::move(mesh),
                        std::move(B),
                        std::move(nodes.B),
                        std::move(nodes.middle_B),
                        std::move(found.error),
                        energy,
                        solved,
                        solved.converged && met};
            }
        }
        mesh = stages.run("mesh", &StageSeconds::mesh, mesh.patch_count(),
                          [&](const WorkMonitor&) { return next_mesh(scene, mesh, plan, options); });
    }
}

}  // namespace patchlight
