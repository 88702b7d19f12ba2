#include "apps/patchlight/planned_solve.h"

#include "apps/patchlight/given_mesh.h"
#include "apps/patchlight/seen_points.h"
#include "apps/patchlight/solve_run.h"
#include "apps/patchlight/view_choice.h"

namespace patchlight {

PlannedSolve plan_solve(const SolveCommand& given, SceneInput& input, const RayCaster& caster)
{
    PlannedSolve plan{given, {}, {}};
    SolveCommand& command = plan.command;
    if (!command.mesh_of.empty()) {
        GivenMesh given_mesh = mesh_of_run(command.mesh_of, input.scene);
        command.mesh_sha256 = given_mesh.sha256;
        command.options.max_elements = command.options.meshing.max_elements = given_mesh.arrays.triangles.size();
        command.options.mesh = std::move(given_mesh.arrays);
    }
    if (command.pictures.pictures) {
        plan.view = chosen_view(command.scene.view, input.scene, caster);
        // Stored first: `render` without --view shows what the run's own pictures show.
        std::erase_if(input.scene.views, [&](const View& other) { return other.name == plan.view.name; });
        input.scene.views.insert(input.scene.views.begin(), plan.view);
    }
    if (!command.for_view.empty()) {
        command.goal = chosen_view(command.for_view, input.scene, caster);
        command.options.looked_at = seen_points(input.scene, caster, *command.goal);
    }
    plan.identity = identity_of(input, command, plan.view);
    return plan;
}

}  // namespace patchlight
