#include "apps/patchlight/planned_solve.h"

#include "apps/imaging/view_rays.h"
#include "apps/patchlight/given_mesh.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/solve_run.h"
#include "apps/patchlight/view_choice.h"

#include <limits>

namespace patchlight {

namespace {

/// What a camera sees, through the pixels of a small picture of it.
std::vector<SurfacePoint> seen_points(const Scene& scene, const RayCaster& caster, const View& view)
{
    constexpr int height = 120;
    const int width = picture_size(std::nullopt, view).first * height / picture_size(std::nullopt, view).second;
    const ViewRays camera(view, width, height);
    RayBatch rays;
    HitBatch hits;
    rays.resize(static_cast<std::size_t>(width) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rays.set(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                     camera.from(), camera.direction(x + 0.5, y + 0.5), std::numeric_limits<float>::infinity());
    caster.closest(rays, hits);
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits.surface[i] >= HitBatch::black_back) continue;
        const SurfaceId surface(hits.surface[i]);
        const Vec3 place = scene.surface(surface).frame.lift(Vec2(hits.x[i], hits.y[i]));
        points.push_back({place, surface, place});
    }
    return points;
}

}  // namespace

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
