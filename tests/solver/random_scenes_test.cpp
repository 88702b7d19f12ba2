// 1,000 scenes in which much touches, crosses and coincides: meshes with their lines, refined; and some solved.
#include "formfactor/shadow_lines.h"
#include "solver/adaptive.h"
#include "tests/formfactor/random_scenes.h"
#include "tests/meshing/mesh_checks.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

using testing::expect_sound_mesh;
using testing::random_boxes;
using testing::random_plan;

std::vector<SurfaceLine> all_lines(const Scene& scene)
{
    std::vector<SurfaceLine> lines = scene.contact_lines;
    const std::vector<SurfaceLine> shadows = shadow_lines(scene, emitters(scene));
    lines.insert(lines.end(), shadows.begin(), shadows.end());
    return lines;
}

/// Corners are snapped at 1e-8 of the diameter after areas are found: of surfaces narrower than a hundredth of it,
/// this.
constexpr double snapped = 1e-7;

bool any_failure()
{
    return ::testing::Test::HasFailure();
}

TEST(RandomScenes, MeshesWithAllLinesAreSoundAndStayItWhenRefined)
{
    std::size_t lines = 0, inserted = 0, patches = 0;
    for (std::uint32_t seed = 1; seed <= 1000 && !any_failure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = random_boxes(seed);
        RefinementPlan plan;
        plan.lines = all_lines(scene);
        PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 4});
        mesh = refine(scene, mesh, plan, {}).mesh;
        expect_sound_mesh(scene, mesh, snapped);
        for (std::uint32_t round = 0; round < 3; ++round)
            mesh = refine(scene, mesh, random_plan(mesh, 0.3, 10 * seed + round), {}).mesh;
        expect_sound_mesh(scene, mesh, snapped);
        lines += plan.lines.size();
        patches += mesh.patch_count();
        for (const MeshLine& line : mesh.lines()) inserted += !line.beyond;
    }
    std::printf("%zu lines, %zu edges on lines, %zu patches\n", lines, inserted, patches);
    EXPECT_GT(inserted, lines / 2);
}

TEST(RandomScenes, TheWholeLoopEndsWithNumbers)
{
    AdaptiveOptions options;
    options.max_elements = 300;
    options.form_factors.rays = 64;
    options.gather.rays = 64;
    options.estimate.rays = 32;
    options.iterations = 6;
    for (std::uint32_t seed = 1; seed <= 30 && !any_failure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = random_boxes(seed);
        const std::size_t outline = triangulate(scene, {.max_edge = 1e9, .min_angle = 0}).patch_count();
        const AdaptiveSolution solution = solve_adaptively(scene, options);
        expect_sound_mesh(scene, solution.mesh, snapped);
        EXPECT_LE(solution.mesh.patch_count(), std::max(options.max_elements, 2 * outline));
        for (const VertexId v : solution.mesh.vertices()) {
            const Rgb B = solution.vertex_B[v], E = scene.material_of(solution.mesh.surface(v)).emission;
            for (int band = 0; band < 3; ++band) {
                EXPECT_TRUE(std::isfinite(B[band]));
                EXPECT_GE(B[band], E[band]);
            }
        }
        EXPECT_TRUE(std::isfinite(solution.error.relative));
    }
}

}  // namespace
}  // namespace patchlight
