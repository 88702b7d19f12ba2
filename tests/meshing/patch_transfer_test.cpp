#include "meshing/refinement.h"

#include "tests/meshing/line_checks.h"

#include <gtest/gtest.h>

#include <random>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// `moved`: how far old edges may lie beside where they were, m.
void expect_complete(const PatchMesh& old_mesh, const PatchMesh& new_mesh, const PatchTransfer& transfer,
                     double moved = 0)
{
    ASSERT_EQ(transfer.start.size(), new_mesh.patch_count() + 1);
    ASSERT_EQ(transfer.start.back(), transfer.overlaps.size());
    std::vector<double> covered(old_mesh.patch_count(), 0);
    for (const PatchId p : new_mesh.patches()) {
        double sum = 0;
        for (std::uint32_t i = transfer.start[p.value]; i < transfer.start[p.value + 1]; ++i) {
            const auto& overlap = transfer.overlaps[i];
            ASSERT_LT(overlap.old_patch.value, old_mesh.patch_count());
            EXPECT_EQ(old_mesh.surface(overlap.old_patch), new_mesh.surface(p));
            EXPECT_GE(overlap.area, 0);
            sum += overlap.area;
            covered[overlap.old_patch.value] += overlap.area;
        }
        EXPECT_NEAR(sum, new_mesh.area(p), 1e-9 * new_mesh.area(p));
    }
    for (const PatchId p : old_mesh.patches()) {
        EXPECT_NEAR(covered[p.value], old_mesh.area(p), 1e-9 * old_mesh.area(p) + 3 * moved * old_mesh.longest_edge(p))
            << "old patch " << p.value;
    }
}

Rgb integral(const PatchMesh& mesh, const PatchField<Rgb>& values)
{
    Rgb sum(0.0);
    for (const PatchId p : mesh.patches()) sum += mesh.area(p) * values[p];
    return sum;
}

PatchField<Rgb> random_values(const PatchMesh& mesh, std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    PatchField<Rgb> values(mesh.patch_count());
    for (const PatchId p : mesh.patches()) values[p] = {unit(random), 100 * unit(random), 1e-3 * unit(random)};
    return values;
}

void expect_conserved(const PatchMesh& old_mesh, const Refinement& refined, double relative = 1e-12)
{
    const PatchField<Rgb> values = random_values(old_mesh, 8);
    const PatchField<Rgb> carried = prolong(refined.mesh, values, refined.transfer);
    const Rgb before = integral(old_mesh, values), after = integral(refined.mesh, carried);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(after[band], before[band], relative * before[band]);
    // An average lies between what it is the average of.
    EXPECT_GE(std::min_element(carried.values().begin(), carried.values().end(),
                               [](const Rgb& a, const Rgb& b) { return a.r < b.r; })
                  ->r,
              0);
}

}  // namespace

TEST(PatchTransfer, areas_are_complete_and_light_is_conserved)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons()) {
        for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
            const Scene scene = flat_scene(loops, 0.5, frame);
            PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 8});
            for (int round = 0; round < 4; ++round) {
                SCOPED_TRACE(name + (frame.origin.x > 0 ? ", tilted" : "") + ", round " + std::to_string(round));
                Refinement refined = refine(scene, mesh, random_plan(mesh, 0.05, seed++), {});
                expect_complete(mesh, refined.mesh, refined.transfer);
                expect_conserved(mesh, refined);
                mesh = std::move(refined.mesh);
            }
        }
    }
}

TEST(PatchTransfer, scenes_of_many_surfaces)
{
    const Scene scene = cornell_box();
    PatchMesh mesh = triangulate(scene, {.max_elements = 600});
    for (std::uint32_t round = 0; round < 3; ++round) {
        Refinement refined = refine(scene, mesh, random_plan(mesh, 0.1, round), {});
        expect_complete(mesh, refined.mesh, refined.transfer);
        expect_conserved(mesh, refined);
        mesh = std::move(refined.mesh);
    }
}

// Over contact lines, which are cut open, and over surfaces that are meshed anew.
TEST(PatchTransfer, meshes_that_get_lines)
{
    const Scene scene = cornell_box();
    PatchMesh mesh = triangulate(scene, {.max_elements = 600});
    RefinementPlan plan = random_plan(mesh, 0.3, 1);
    plan.lines = crosses(scene);
    for (std::uint32_t round = 0; round < 3; ++round) {
        Refinement refined = refine(scene, mesh, plan, {});
        // Where lines cross, the older one takes a vertex that is rounded to 2⁻³⁰ of the diameter.
        const double moved = 1e-9 * scene.diameter;
        expect_complete(mesh, refined.mesh, refined.transfer, moved);
        expect_conserved(mesh, refined, 1e-7);
        mesh = std::move(refined.mesh);
        plan = random_plan(mesh, 0.3, round);
        for (const SurfaceLine& line : crosses(scene))
            plan.lines.push_back({line.surface, LineKind::contact, line.start,
                                  line.end + 0.1 * (round + 1.0) * Vec2(line.end.y - line.start.y, 0)});
    }
}

TEST(PatchTransfer, strongly_graded_meshes)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)}, 0.5, tilted_frame());
    PatchMesh mesh = triangulate(scene, {.max_edge = 0.5});
    for (int round = 0; round < 12; ++round) {
        Refinement refined = refine(scene, mesh, plan_towards(mesh, scene.vertices[2]), {});
        expect_complete(mesh, refined.mesh, refined.transfer);
        expect_conserved(mesh, refined);
        mesh = std::move(refined.mesh);
    }
}

TEST(PatchTransfer, an_empty_plan_carries_every_value_to_its_own_patch)
{
    const Scene scene = cornell_box();
    const PatchMesh mesh = triangulate(scene, {.max_elements = 600});
    const Refinement refined = refine(scene, mesh, {}, {});
    const PatchField<Rgb> values = random_values(mesh, 1);
    const PatchField<Rgb> carried = prolong(refined.mesh, values, refined.transfer);
    for (const PatchId p : mesh.patches()) {
        // Neighbours share an edge: they may have a rounding's worth of area in common.
        for (int band = 0; band < 3; ++band)
            EXPECT_NEAR(carried[p][band], values[p][band], 1e-12 * values[p][band]) << p.value;
    }
}

// Meshes that have nothing to do with each other but the surface.
TEST(PatchTransfer, from_any_mesh_to_any_other)
{
    for (const auto& [name, loops] : blunt_polygons()) {
        SCOPED_TRACE(name);
        const Scene scene = flat_scene(loops, 0.5, tilted_frame());
        const PatchMesh fine = triangulate(scene, {.max_edge = scene.diameter / 23});
        const PatchMesh coarse = triangulate(scene, {.max_edge = scene.diameter / 9});
        expect_complete(fine, coarse, overlap(fine, PatchLocator(fine), coarse));
        expect_complete(coarse, fine, overlap(coarse, PatchLocator(coarse), fine));
    }
}

TEST(PatchTransfer, a_constant_stays_the_constant)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1), turned(rectangle_loop(0.3, 0.3, 0.7, 0.6))});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.2});
    const Refinement refined = refine(scene, mesh, random_plan(mesh, 0.3, 6), {});
    const PatchField<Rgb> carried =
        prolong(refined.mesh, PatchField<Rgb>(mesh.patch_count(), Rgb(1, 2, 3)), refined.transfer);
    for (const Rgb& x : carried.values()) EXPECT_NEAR(glm::distance(x, Rgb(1, 2, 3)), 0, 1e-12);
}
