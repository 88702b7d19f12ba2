#include "solver/adaptive.h"

#include "solver/invariants.h"
#include "solver/light_stages.h"
#include "solver/mesh_stages.h"

#include <utility>

namespace patchlight {

namespace {

Stage stage_of(int cycle, bool last, const AdaptiveOptions& options)
{
    if (options.refine == Refine::none) return Stage::uniform;
    if (last) return Stage::final;
    return cycle == 0 ? Stage::rough : Stage::adaptive;
}

}  // namespace

AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers, std::optional<AdaptiveStart> start)
{
    const RayCaster caster(scene);
    Stages stages(observers.on_progress, observers.stop);
    const Emitted emitted = emitted_light(scene, options, stages);
    const PatchMesh uniform = first_mesh(scene, options);
    const PatchLocator uniform_locator(uniform);
    const Exchange coarse{scene, caster, uniform, uniform_locator, emitted.direct()};
    KeptRows* const kept = options.refine == Refine::none ? observers.rows : nullptr;
    RadiositySystem system = assemble_patches(coarse, options, stages, kept);
    const PatchSolution patches = solve_patches(coarse, system, options, stages);
    require_none(broken_invariants(system, patches.B, scene.closed, invariant_tolerances(options)), scene, uniform);
    const Lighting lighting(coarse, emitted, system, patches, options, stages, kept);
    // Of a run that is continued they are counted already.
    std::size_t rays = start ? 0 : lighting.rays();

    PatchMesh mesh = start ? std::move(start->mesh) : PatchMesh(scene, uniform.arrays());
    for (int cycle = start ? start->cycle : 0;; ++cycle) {
        stages.cycle = cycle;
        const PatchLocator locator(mesh);
        const Exchange exchange{scene, caster, mesh, locator, emitted.direct()};
        RefinementPlan plan;
        if (start) {  // this cycle was observed by the run that is continued
            plan = plan_next(scene, mesh, start->B, start->error, lighting.counted(mesh, start->error), emitted.lines,
                             options);
            start.reset();
        } else {
            Evaluation found = lighting.evaluated(exchange, options, stages);
            Radiosity B = cycle == 0 ? patches.B : patch_means(mesh, found.vertex_B);
            plan = plan_next(scene, mesh, B, found.error, lighting.counted(mesh, found.error), emitted.lines, options);
            const bool last = finished(mesh, found.error, plan, cycle, options);
            Reconstruction nodes{std::move(found.vertex_B), {}, 0};
            if (last) nodes = lighting.final_nodes(exchange, std::move(nodes), options, stages);
            require_none(broken_invariants(scene, mesh, B, nodes), scene, mesh);
            rays += found.rays + nodes.rays;
            const EnergyBalance energy = last && cycle > 0 ? lighting.energy(mesh, locator, B) : patches.energy;
            if (observers.on_step)
                observers.on_step({cycle, stage_of(cycle, last, options), mesh, B, nodes.B, nodes.middle_B,
                                   patches.report, found.error, energy,
                                   last ? 0 : plan.bisections.size() + plan.lines.size(),
                                   count_lines(scene, mesh, emitted.lines), std::exchange(rays, 0), stages.seconds});
            stages.seconds = {};
            if (last) {
                const bool met = options.target_error <= 0 || found.error.relative <= options.target_error;
                return {std::move(mesh),        std::move(B), std::move(nodes.B), std::move(nodes.middle_B),
                        std::move(found.error), energy,       patches.report,     patches.report.converged && met};
            }
        }
        mesh = next_mesh(scene, mesh, plan, options, stages);
    }
}

}  // namespace patchlight
