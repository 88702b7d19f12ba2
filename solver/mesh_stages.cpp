#include "solver/mesh_stages.h"

#include <algorithm>

namespace patchlight {

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

PatchMesh next_mesh(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan,
                    const AdaptiveOptions& options, Stages& stages)
{
    MeshingOptions meshing = options.meshing;
    meshing.max_elements = options.max_elements;
    return stages.run("mesh", &StageSeconds::mesh, mesh.patch_count(), [&](const WorkMonitor&) {
        return options.refine == Refine::discontinuity ? triangulate(scene, meshing, plan.lines)
                                                       : refined(scene, mesh, plan, meshing);
    });
}

}  // namespace patchlight
