#include "solver/light_stages.h"

#include "solver/hierarchical.h"
#include "solver/importance.h"
#include "solver/mesh_stages.h"

#include <tbb/parallel_for.h>
#include <utility>

namespace patchlight {

namespace {

/// Puts another E into a system while it lives.
class OtherSource {
public:
    OtherSource(RadiositySystem& system, PatchField<Rgb> E)
        : system_(system), kept_(std::exchange(system.E, std::move(E)))
    {}
    OtherSource(const OtherSource&) = delete;
    OtherSource& operator=(const OtherSource&) = delete;
    ~OtherSource() { system_.E = std::move(kept_); }

private:
    RadiositySystem& system_;
    PatchField<Rgb> kept_;
};

PatchSolution solve_on_links(const Exchange& exchange, const RadiositySystem& system, const AdaptiveOptions& options,
                             const WorkMonitor& monitor)
{
    PatchSolution solution;
    solution.B = system.E;
    const HierarchicalOptions links{.tolerance = options.final.tolerance, .seed = options.form_factors.seed};
    const HierarchicalSolution found = solve_hierarchical(exchange, system, solution.B, links, monitor);
    solution.report = found.report;
    solution.energy = found.energy;
    solution.rays = found.rays;
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

}  // namespace

Emitted emitted_light(const Scene& scene, const AdaptiveOptions& options, Stages& stages)
{
    Emitted emitted;
    emitted.uses_exact = options.direct == Direct::exact;
    if (emitted.uses_exact || uses_lines(options))
        emitted.exact = stages.run("direct", &StageSeconds::mesh, 0,
                                   [&](const WorkMonitor& monitor) { return emitters_light(scene, monitor); });
    if (uses_lines(options))
        emitted.lines = stages.run("lines", &StageSeconds::mesh, 0, [&](const WorkMonitor& monitor) {
            return discontinuities(scene, emitted.exact ? &*emitted.exact : nullptr, options.lines, monitor);
        });
    const std::vector<SurfaceId> sources = emitters(scene);
    if (options.direct == Direct::sampled && sources.size() <= RowSampler::most_sources)
        for (const SurfaceId s : sources) emitted.light.sources.emplace_back(scene, s);
    return emitted;
}

RadiositySystem assemble_patches(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages,
                                 KeptRows* kept)
{
    return stages.run(
        "assemble", &StageSeconds::assemble, exchange.mesh.patch_count(), [&](const WorkMonitor& monitor) {
            if (options.final.solver == Solver::hierarchical) return unassembled(exchange);
            RadiositySystem made = assemble(exchange, options.form_factors, monitor, kept ? &kept->patches : nullptr);
            if (options.final.solver == Solver::conjugate_gradient) make_reciprocal(made, exchange.scene.closed);
            return made;
        });
}

PatchSolution solve_patches(const Exchange& exchange, RadiositySystem& system, const AdaptiveOptions& options,
                            Stages& stages)
{
    const std::size_t n = exchange.mesh.patch_count();
    if (options.final.solver == Solver::hierarchical)
        return stages.run("solve", &StageSeconds::solve, n, [&](const WorkMonitor& monitor) {
            return solve_on_links(exchange, system, options, monitor);
        });
    PatchSolution solution;
    const auto solve_it = [&](const WorkMonitor& monitor) { return solve(system, solution.B, options.final, monitor); };
    if (exchange.direct) {
        PatchField<Rgb> first(n);
        for (std::size_t i = 0; i < n; ++i) first[PatchId(i)] = system.rho[PatchId(i)] * system.direct[PatchId(i)];
        solution.B = Radiosity(n, Rgb(0.0));
        const OtherSource reflected(system, std::move(first));
        solution.report = stages.run("solve", &StageSeconds::solve, n, solve_it);
    } else {
        solution.B = system.E;
        solution.report = stages.run("solve", &StageSeconds::solve, n, solve_it);
    }
    if (exchange.direct)
        for (std::size_t i = 0; i < n; ++i) solution.B[PatchId(i)] += system.E[PatchId(i)];
    solution.energy = energy_balance(system, solution.B);
    solution.rays = system.F.rays + solution.report.rays;
    return solution;
}

Lighting::Lighting(const Exchange& coarse, const Emitted& emitted, const RadiositySystem& system,
                   const PatchSolution& patches, const AdaptiveOptions& options, Stages& stages, KeptRows* kept)
    : coarse_(coarse), emitted_(emitted), system_(system), patches_(patches), gather_(options.gather), kept_(kept),
      weights_(weights_of(coarse, system, options, stages))
{
    if (options.refine == Refine::none) return;
    const RoughSolution rough{coarse_, system_, patches_.B, weights_.empty() ? nullptr : &weights_};
    indirect_ =
        stages.run("indirect", &StageSeconds::gather, coarse_.mesh.patch_count(), [&](const WorkMonitor& monitor) {
            return solve_indirect(rough, emitted_.light, indirect_options(options), monitor);
        });
}

LightAtPoints Lighting::on(const Exchange& exchange, int gather_rays, FormFactorMatrix* kept) const
{
    if (indirect_) return light_of(exchange, emitted_.light, *indirect_, gather_);
    GatherOptions gather = gather_;
    gather.rays = gather_rays;
    return light_from_patches(coarse_, patches_.B, gather, kept);
}

Evaluation Lighting::evaluated(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages) const
{
    return stages.run(
        "estimate", &StageSeconds::estimate, exchange.mesh.patch_count(), [&](const WorkMonitor& monitor) {
            return evaluate(exchange, on(exchange, options.estimate.rays, kept_ ? &kept_->estimate : nullptr),
                            options.estimate.indicator, options.gather.crease_angle, indirect_ ? indirect_->error() : 0,
                            monitor);
        });
}

Reconstruction Lighting::final_nodes(const Exchange& exchange, Reconstruction found, const AdaptiveOptions& options,
                                     Stages& stages) const
{
    if (indirect_ && options.elements == Elements::linear) return found;
    const int rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
    return stages.run("gather", &StageSeconds::gather, exchange.mesh.patch_count(), [&](const WorkMonitor& monitor) {
        return reconstruct(exchange, on(exchange, rays, kept_ ? &kept_->nodes : nullptr), options.gather.crease_angle,
                           monitor, options.elements);
    });
}

ErrorEstimate Lighting::counted(const PatchMesh& mesh, const ErrorEstimate& error) const
{
    return weights_.empty() ? error : weighted(error, weights_on(coarse_.scene, mesh, coarse_.locator, weights_));
}

EnergyBalance Lighting::energy(const PatchMesh& mesh, const PatchLocator& locator, const Radiosity& B) const
{
    if (system_.F.size() == 0) return patches_.energy;
    return energy_balance(system_, prolong(coarse_.mesh, B, overlap(mesh, locator, coarse_.mesh)));
}

}  // namespace patchlight
