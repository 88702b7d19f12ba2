#include "meshing/refinement.h"

#include "tests/meshing/flat_scenes.h"
#include "tests/meshing/mesh_checks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <tuple>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// Every new patch whose centroid lies in a split patch is as small as that split asks.
void expect_obeyed(const Scene& scene, const PatchMesh& old_mesh, const RefinementPlan& plan, const PatchMesh& new_mesh)
{
    const PatchLocator locator(old_mesh);
    std::vector<double> target(old_mesh.patch_count(), 1e300);
    for (const auto& split : plan.splits)
        target[split.patch.value] = std::min(target[split.patch.value], split.target_edge);
    for (const PatchId p : new_mesh.patches()) {
        Vec2 middle(0.0);
        for (const VertexId v : new_mesh.corners(p)) middle += new_mesh.plane_position(v) / 3.0;
        const PatchId under =
            locator.locate(new_mesh.surface(p), static_cast<float>(middle.x), static_cast<float>(middle.y));
        // Meshing tells places apart to 2⁻³⁰ of the diameter.
        EXPECT_LE(new_mesh.longest_edge(p), target[under.value] * (1 + 1e-6) + 3e-9 * scene.diameter);
    }
}

std::vector<Vec3> sorted_positions(const PatchMesh& mesh)
{
    std::vector<Vec3> positions = mesh.arrays().positions;
    std::sort(positions.begin(), positions.end(),
              [](const Vec3& a, const Vec3& b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); });
    return positions;
}

/// To the bit.
void expect_old_vertices_stay(const PatchMesh& old_mesh, const PatchMesh& new_mesh)
{
    const auto before = sorted_positions(old_mesh), after = sorted_positions(new_mesh);
    EXPECT_TRUE(
        std::includes(after.begin(), after.end(), before.begin(), before.end(), [](const Vec3& a, const Vec3& b) {
            return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z);
        }));
}

std::vector<std::array<std::uint32_t, 3>> lowest_corner_first(const PatchMesh& mesh)
{
    auto triangles = mesh.arrays().triangles;
    for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return triangles;
}

/// The largest splits of a random plan first.
RefinementPlan worst_first(const PatchMesh& mesh, double share, std::uint32_t seed)
{
    RefinementPlan plan = random_plan(mesh, share, seed);
    std::stable_sort(plan.splits.begin(), plan.splits.end(),
                     [&](const auto& a, const auto& b) { return mesh.area(a.patch) > mesh.area(b.patch); });
    return plan;
}

}  // namespace

TEST(Refine, rounds_of_random_plans_keep_all_promises)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons()) {
        for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
            const Scene scene = flat_scene(loops, 0.5, frame);
            PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 8});
            for (int round = 0; round < 6; ++round) {
                SCOPED_TRACE(name + (frame.origin.x > 0 ? ", tilted" : "") + ", round " + std::to_string(round));
                const RefinementPlan plan = random_plan(mesh, 0.03, seed++);
                PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
                expect_sound_mesh(scene, refined);
                expect_obeyed(scene, mesh, plan, refined);
                expect_old_vertices_stay(mesh, refined);
                EXPECT_GE(smallest_angle(refined), 18);
                mesh = std::move(refined);
            }
        }
    }
}

TEST(Refine, towards_a_corner_the_cost_is_that_of_the_corner)
{
    const Scene scene = grey_cube();
    PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    const std::size_t coarse = mesh.patch_count();
    for (int round = 0; round < 16; ++round) {
        const RefinementPlan plan = plan_towards(mesh, {1, 1, 1});
        PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
        expect_obeyed(scene, mesh, plan, refined);
        EXPECT_GE(smallest_angle(refined), 18);
        mesh = std::move(refined);
    }
    expect_sound_mesh(scene, mesh);
    // A graded mesh needs a fixed number of patches each time its finest edge is halved.
    EXPECT_LT(mesh.patch_count(), coarse + 16 * 60);
}

TEST(Refine, an_empty_plan_changes_nothing)
{
    for (const Scene& scene : {grey_cube(), cornell_box(), flat_scene(sharp_triangle(5), 0.5, tilted_frame())}) {
        PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 15});
        mesh = refine(scene, mesh, random_plan(mesh, 0.1, 5), {}).mesh;
        PatchMesh again = refine(scene, mesh, {}, {}).mesh;
        expect_same_mesh(mesh, again);
        EXPECT_EQ(mesh.areas(), again.areas());
        again = refine(scene, again, {}, {}).mesh;
        expect_same_mesh(mesh, again);
    }
}

TEST(Refine, a_plan_already_obeyed_changes_nothing)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.3});
    RefinementPlan plan;
    for (const PatchId p : mesh.patches()) plan.splits.push_back({p, mesh.longest_edge(p) * (1 + 1e-6)});
    const PatchMesh again = refine(scene, mesh, plan, {}).mesh;
    EXPECT_EQ(again.arrays().positions, mesh.arrays().positions);
    EXPECT_EQ(lowest_corner_first(again), lowest_corner_first(mesh));
}

TEST(Refine, surfaces_without_a_split_are_left_alone)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.4});
    const SurfaceId split(std::size_t{2});
    RefinementPlan plan;
    for (const PatchId p : mesh.patches_of(split)) plan.splits.push_back({p, 0.1});
    const PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
    for (std::uint32_t s = 0; s < 6; ++s) {
        const std::size_t before = mesh.patches_of(SurfaceId(s)).size(),
                          after = refined.patches_of(SurfaceId(s)).size();
        if (s == split.value) {
            EXPECT_GT(after, 4 * before);
        } else {
            EXPECT_EQ(after, before);
        }
    }
    EXPECT_LE(longest_edge(refined), 0.4 * (1 + 1e-9));
}

TEST(Refine, sharp_corners_of_the_input_end)
{
    for (const double degrees : {0.5, 5.0, 12.0}) {
        SCOPED_TRACE(degrees);
        const Scene scene = flat_scene(sharp_triangle(degrees), 0.5, tilted_frame());
        PatchMesh mesh = triangulate(scene, {.max_edge = 0.2});
        for (int round = 0; round < 6; ++round) {
            const RefinementPlan plan =
                round % 2 == 0 ? random_plan(mesh, 0.2, 3) : plan_towards(mesh, scene.vertices[0]);
            PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
            expect_sound_mesh(scene, refined);
            expect_obeyed(scene, mesh, plan, refined);
            // A quarter of the edge is sixteen times the patches; what is sharp already may need four times these.
            EXPECT_LE(refined.patch_count(), mesh.patch_count() + 64 * (plan.splits.size() + 1));
            mesh = std::move(refined);
        }
    }
}

TEST(Refine, the_budget_is_kept_and_spent_on_the_first_splits)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.4});
    const RefinementPlan plan = worst_first(mesh, 0.05, 9);
    const std::size_t all = refine(scene, mesh, plan, {}).mesh.patch_count();
    ASSERT_GT(plan.splits.size(), 15U);
    std::size_t fewest = all;
    for (const double share : {1.0, 0.9, 0.5, 0.2}) {
        const std::size_t budget =
            mesh.patch_count() + static_cast<std::size_t>(share * static_cast<double>(all - mesh.patch_count()));
        const PatchMesh bounded = refine(scene, mesh, plan, {.max_elements = budget}).mesh;
        EXPECT_LE(bounded.patch_count(), budget);
        EXPECT_GT(bounded.patch_count(), mesh.patch_count() + (budget - mesh.patch_count()) / 2) << "share " << share;
        // It is what the first splits alone give.
        bool is_prefix = false;
        RefinementPlan first;
        for (std::size_t k = 0; k <= plan.splits.size() && !is_prefix; ++k) {
            first.splits.assign(plan.splits.begin(), plan.splits.begin() + static_cast<std::ptrdiff_t>(k));
            is_prefix = refine(scene, mesh, first, {}).mesh.arrays().positions == bounded.arrays().positions;
        }
        EXPECT_TRUE(is_prefix) << "share " << share;
        EXPECT_LE(bounded.patch_count(), fewest);
        fewest = bounded.patch_count();
    }
}

TEST(Refine, a_budget_already_spent_gives_the_same_mesh)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.4});
    const RefinementPlan plan = random_plan(mesh, 0.3, 4);
    for (const std::size_t budget :
         {mesh.patch_count(), mesh.patch_count() - 5, mesh.patch_count() + 1, std::size_t{1}}) {
        expect_same_mesh(mesh, refine(scene, mesh, plan, {.max_elements = budget}).mesh);
    }
}

TEST(Refine, threads_do_not_change_the_mesh)
{
    const Scene scene = cornell_box();
    const PatchMesh mesh = triangulate(scene, {.max_elements = 1000});
    std::vector<Refinement> results;
    for (const std::size_t threads : {1U, 2U, 2U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(refine(scene, mesh, random_plan(mesh, 0.3, 2), {.max_elements = 2500}));
    }
    for (const std::size_t k : {1U, 2U}) {
        expect_same_mesh(results[0].mesh, results[k].mesh);
        EXPECT_EQ(results[0].transfer.start, results[k].transfer.start);
        ASSERT_EQ(results[0].transfer.overlaps.size(), results[k].transfer.overlaps.size());
        for (std::size_t i = 0; i < results[0].transfer.overlaps.size(); ++i) {
            EXPECT_EQ(results[0].transfer.overlaps[i].old_patch, results[k].transfer.overlaps[i].old_patch);
            EXPECT_EQ(results[0].transfer.overlaps[i].area, results[k].transfer.overlaps[i].area);
        }
    }
}
