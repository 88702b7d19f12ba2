#include "meshing/refinement.h"

#include "tests/meshing/line_checks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <compare>
#include <optional>
#include <tuple>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// A place on a surface, to the bit.
using Place = std::tuple<SurfaceId, double, double, double>;
using Edge = std::pair<Place, Place>;

Place place(SurfaceId surface, const Vec3& p)
{
    return {surface, p.x, p.y, p.z};
}

std::set<Place> places(const PatchMesh& mesh)
{
    std::set<Place> result;
    for (const VertexId v : mesh.vertices()) result.insert(place(mesh.surface(v), mesh.position(v)));
    return result;
}

Edge edge_of(const PatchMesh& mesh, PatchId p, std::size_t k)
{
    const auto c = mesh.corners(p);
    return std::minmax(place(mesh.surface(p), mesh.position(c[k])),
                       place(mesh.surface(p), mesh.position(c[(k + 1) % 3])));
}

std::set<Edge> edges(const PatchMesh& mesh)
{
    std::set<Edge> result;
    for (const PatchId p : mesh.patches())
        for (std::size_t k = 0; k < 3; ++k) result.insert(edge_of(mesh, p, k));
    return result;
}

Place middle(const PatchMesh& mesh, const RefinementPlan::Bisection& bisection)
{
    const auto c = mesh.corners(bisection.patch);
    const std::size_t k = bisection.edge;
    return place(mesh.surface(bisection.patch), 0.5 * (mesh.position(c[k]) + mesh.position(c[(k + 1) % 3])));
}

/// Old vertices stay, to the bit; each edge of the plan is gone, and its middle is a vertex; there are no others.
void expect_bisected(const PatchMesh& old_mesh, const RefinementPlan& plan, const PatchMesh& new_mesh)
{
    std::set<Place> expected = places(old_mesh);
    const std::set<Edge> left = edges(new_mesh);
    for (const auto& bisection : plan.bisections) {
        expected.insert(middle(old_mesh, bisection));
        EXPECT_FALSE(left.contains(edge_of(old_mesh, bisection.patch, bisection.edge)));
    }
    EXPECT_EQ(places(new_mesh), expected);
}

/// A patch more for an edge of the border, two for any other.
std::size_t patches_after(const PatchMesh& mesh, const RefinementPlan& plan)
{
    std::set<Edge> halved;
    std::size_t patches = mesh.patch_count();
    for (const auto& [p, k] : plan.bisections)
        if (halved.insert(edge_of(mesh, p, k)).second) patches += mesh.neighbours(p)[k].valid() ? 2 : 1;
    return patches;
}

/// The first of the plan that halve so many edges.
RefinementPlan first_edges(const PatchMesh& mesh, const RefinementPlan& plan, std::size_t count)
{
    RefinementPlan first;
    std::set<Edge> halved;
    for (const auto& bisection : plan.bisections) {
        halved.insert(edge_of(mesh, bisection.patch, bisection.edge));
        if (halved.size() > count) break;
        first.bisections.push_back(bisection);
    }
    return first;
}

}  // namespace

TEST(Refine, rounds_of_random_bisections_keep_all_promises)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons()) {
        for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
            const Scene scene = flat_scene(loops, 0.5, frame);
            PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 8});
            for (int round = 0; round < 6; ++round) {
                SCOPED_TRACE(name + (frame.origin.x > 0 ? ", tilted" : "") + ", round " + std::to_string(round));
                // All patches at once, too: then flips take edges away before it's their turn.
                const RefinementPlan plan = random_plan(mesh, round == 2 ? 1 : 0.1, seed++);
                PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
                expect_sound_mesh(scene, refined);
                expect_delaunay(scene, refined);
                expect_bisected(mesh, plan, refined);
                EXPECT_EQ(refined.patch_count(), patches_after(mesh, plan));
                mesh = std::move(refined);
            }
        }
    }
}

TEST(Refine, an_edge_named_by_both_its_patches_is_halved_once)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 2});
    ASSERT_EQ(mesh.patch_count(), 2U);
    RefinementPlan plan;
    for (const PatchId p : mesh.patches())
        for (std::uint8_t k = 0; k < 3; ++k)
            if (mesh.neighbours(p)[k].valid()) plan.bisections.push_back({p, k});
    ASSERT_EQ(plan.bisections.size(), 2U);
    const PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
    EXPECT_EQ(refined.patch_count(), 4U);
    expect_bisected(mesh, plan, refined);
}

// Halving what is longest at a corner again and again: two patches a time, whatever the grading, and it goes on until
// patches are as small as meshing's rounding.
TEST(Refine, towards_a_corner_each_bisection_costs_two_patches)
{
    const Scene scene = grey_cube();
    PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    const std::size_t coarse = mesh.patch_count();
    for (std::size_t round = 1; round <= 100; ++round) {
        mesh = refine(scene, mesh, plan_towards(mesh, {1, 1, 1}), {}).mesh;
        EXPECT_LE(mesh.patch_count(), coarse + 2 * round);
    }
    expect_sound_mesh(scene, mesh);
    expect_delaunay(scene, mesh);
    double smallest = 1;
    for (const PatchId p : mesh.patches()) smallest = std::min(smallest, mesh.longest_edge(p));
    EXPECT_LT(smallest, 1e-6);
}

TEST(Refine, what_is_as_small_as_rounding_stays_whole)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)}, 0.5, tilted_frame());
    PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    for (int round = 0; round < 200; ++round)
        mesh = refine(scene, mesh, plan_towards(mesh, scene.vertices[2]), {}).mesh;
    expect_sound_mesh(scene, mesh);
    const PatchMesh again = refine(scene, mesh, plan_towards(mesh, scene.vertices[2]), {}).mesh;
    EXPECT_EQ(again.arrays().positions, mesh.arrays().positions);
    EXPECT_EQ(again.patch_count(), mesh.patch_count());
}

TEST(Refine, an_empty_plan_changes_nothing)
{
    for (const Scene& scene : {grey_cube(), cornell_box(), flat_scene(sharp_triangle(5), 0.5, tilted_frame())}) {
        PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 15}, crosses(scene));
        mesh = refine(scene, mesh, random_plan(mesh, 0.1, 5), {}).mesh;
        PatchMesh again = refine(scene, mesh, {}, {}).mesh;
        expect_same_mesh(mesh, again);
        EXPECT_EQ(mesh.areas(), again.areas());
        again = refine(scene, again, {}, {}).mesh;
        expect_same_mesh(mesh, again);
    }
}

TEST(Refine, surfaces_without_a_bisection_are_left_alone)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.4});
    const SurfaceId split(std::size_t{2});
    RefinementPlan plan;
    for (const PatchId p : mesh.patches_of(split)) plan.bisections.push_back({p, 0});
    const PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
    for (std::uint32_t s = 0; s < 6; ++s) {
        const auto before = mesh.patches_of(SurfaceId(s)), after = refined.patches_of(SurfaceId(s));
        if (s == split.value) {
            EXPECT_GT(after.size(), before.size());
            continue;
        }
        ASSERT_EQ(after.size(), before.size());
        for (std::uint32_t i = 0; i < before.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_EQ(refined.position(refined.corners(PatchId(after.first + i))[k]),
                          mesh.position(mesh.corners(PatchId(before.first + i))[k]));
    }
}

TEST(Refine, sharp_corners_of_the_input_end)
{
    for (const double degrees : {0.5, 5.0, 12.0}) {
        SCOPED_TRACE(degrees);
        const Scene scene = flat_scene(sharp_triangle(degrees), 0.5, tilted_frame());
        PatchMesh mesh = triangulate(scene, {.max_edge = 0.2});
        for (int round = 0; round < 12; ++round) {
            const RefinementPlan plan =
                round % 2 == 0 ? random_plan(mesh, 0.2, 3) : plan_towards(mesh, scene.vertices[0]);
            PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
            expect_sound_mesh(scene, refined);
            expect_bisected(mesh, plan, refined);
            EXPECT_EQ(refined.patch_count(), patches_after(mesh, plan));
            mesh = std::move(refined);
        }
    }
}

TEST(Refine, the_budget_is_kept_and_spent_on_the_first_bisections)
{
    const Scene scene = grey_cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.4});
    const RefinementPlan plan = random_plan(mesh, 0.3, 9);
    const std::size_t n = mesh.patch_count();
    ASSERT_GT(plan.bisections.size(), 50U);
    for (const std::size_t room : {2U, 3U, 20U, 37U, 80U}) {
        SCOPED_TRACE(room);
        const PatchMesh bounded = refine(scene, mesh, plan, {.max_elements = n + room}).mesh;
        EXPECT_LE(bounded.patch_count(), n + room);
        expect_same_mesh(bounded, refine(scene, mesh, first_edges(mesh, plan, room / 2), {}).mesh);
    }
    const PatchMesh all = refine(scene, mesh, plan, {}).mesh;
    expect_same_mesh(all, refine(scene, mesh, plan, {.max_elements = 10 * n}).mesh);
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

TEST(Refine, lines_are_dropped_from_the_last_until_the_budget_holds)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 2});
    RefinementPlan plan;
    for (int i = 0; i < 40; ++i) {
        const double x = 0.1 + 0.02 * i;
        plan.lines.push_back({SurfaceId(std::size_t{0}), LineKind::ev, {x, 0.2}, {x, 0.8}});
    }
    const PatchMesh refined = refine(scene, mesh, plan, {.max_elements = 60}).mesh;
    expect_sound_mesh(scene, refined);
    EXPECT_LE(refined.patch_count(), 60U);
    ASSERT_GT(refined.lines().size(), 5U);
    for (const MeshLine& line : refined.lines())
        EXPECT_LT(refined.position(VertexId(line.left[0])).x, 0.1 + 0.02 * static_cast<double>(refined.lines().size()));
}

// Whatever asks for lines that can't be had, edges are halved all the same, and nothing is lost.
TEST(Refine, lines_outside_the_surface_change_nothing)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    PatchMesh mesh = triangulate(scene, {.max_edge = 0.3});
    mesh = refine(scene, mesh, random_plan(mesh, 0.3, 1), {}).mesh;
    RefinementPlan plan;
    plan.lines = {{SurfaceId(std::size_t{0}), LineKind::contact, {0.2, 0}, {0.8, 0}},
                  {SurfaceId(std::size_t{0}), LineKind::ev, {0.2, 1.5}, {0.8, 1.5}}};
    expect_same_mesh(mesh, refine(scene, mesh, plan, {}).mesh);
    const RefinementPlan halved = random_plan(mesh, 0.3, 1);
    plan.bisections = halved.bisections;
    expect_same_mesh(refine(scene, mesh, halved, {}).mesh, refine(scene, mesh, plan, {}).mesh);
}

// Edges that already are where a line is asked for: nothing was cut, but each patch has its own number still.
TEST(Refine, a_line_along_edges_halves_no_other_edge)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    PatchMesh mesh = triangulate(scene, {.max_edge = 2});
    RefinementPlan first;
    first.lines = {{SurfaceId(std::size_t{0}), LineKind::ev, {0.2, 0.5}, {0.8, 0.5}}};
    mesh = refine(scene, mesh, first, {}).mesh;
    ASSERT_EQ(mesh.lines().size(), 1U);
    RefinementPlan plan = random_plan(mesh, 0.5, 3);
    plan.lines = first.lines;
    const PatchMesh refined = refine(scene, mesh, plan, {}).mesh;
    expect_sound_mesh(scene, refined);
    for (const Place& p : places(refined)) {
        bool known = places(mesh).contains(p);
        for (const auto& bisection : plan.bisections) known = known || middle(mesh, bisection) == p;
        EXPECT_TRUE(known);
    }
}

TEST(Refine, uniform_meshes_hold_their_lines_and_keep_to_the_budget)
{
    const Scene scene = cornell_box();
    const PatchMesh mesh = triangulate(scene, {.max_elements = 1000}, crosses(scene));
    EXPECT_LE(mesh.patch_count(), 1000U);
    EXPECT_GE(mesh.patch_count(), 800U);
    EXPECT_GE(mesh.lines().size(), 4 * crosses(scene).size() / 2);
    expect_sound_mesh(scene, mesh);
}

TEST(Refine, threads_do_not_change_the_mesh)
{
    const Scene scene = cornell_box();
    const PatchMesh mesh = triangulate(scene, {.max_elements = 1000});
    RefinementPlan plan = random_plan(mesh, 0.5, 2);
    plan.lines = crosses(scene);
    std::erase_if(plan.lines, [](const SurfaceLine& line) { return line.surface.value % 2 == 0; });
    std::vector<Refinement> results;
    for (const std::size_t threads : {1U, 2U, 2U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const PatchMesh lined = refine(scene, mesh, plan, {.max_elements = 2500}).mesh;
        results.push_back(refine(scene, lined, random_plan(lined, 0.8, 3), {.max_elements = 2500}));
    }
    EXPECT_FALSE(results[0].mesh.lines().empty());
    EXPECT_GT(results[0].mesh.patch_count(), 500U);
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
