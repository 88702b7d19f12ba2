// Links between groups of patches against closed forms and the dense system of exact factors.
#include "solver/hierarchical.h"

#include "formfactor/form_factor_matrix.h"
#include "formfactor/random_numbers.h"
#include "meshing/read_scene.h"
#include "solver/light_operator.h"
#include "tests/formfactor/boxes.h"
#include "tests/formfactor/random_scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace patchlight {
namespace {

using testing::cube_inside;

/// A scene with its mesh and what else light is exchanged over.
struct Room {
    Room(Scene s, std::size_t elements, bool exact_direct)
        : scene(std::move(s)), caster(scene), mesh(triangulate(scene, {.max_elements = elements})), locator(mesh),
          direct(exact_direct ? emitters_light(scene) : std::nullopt)
    {}

    Exchange exchange() const { return {scene, caster, mesh, locator, direct ? &*direct : nullptr}; }

    Scene scene;
    RayCaster caster;
    PatchMesh mesh;
    PatchLocator locator;
    std::optional<DirectLight> direct;
};

Scene read(const std::string& name, double unit = 1)
{
    SceneOptions options;
    options.unit = unit;
    return read_scene(std::string(PATCHLIGHT_DATA) + "/scenes/" + name, options).scene;
}

struct Linked {
    Radiosity B;
    HierarchicalSolution solution;
};

Linked linked(const Room& room, double tolerance, const WorkMonitor& monitor = {})
{
    Linked result;
    result.B = emittance(room.scene, room.mesh);
    result.solution =
        solve_hierarchical(room.exchange(), unassembled(room.exchange()), result.B, {.tolerance = tolerance}, monitor);
    return result;
}

/// The same system by exact factors of all pairs.
Radiosity dense(const Room& room)
{
    RadiositySystem system = unassembled(room.exchange());
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    system.F = form_factor_matrix(room.scene, room.caster, room.mesh, room.locator, options, {});
    Radiosity B = emittance(room.scene, room.mesh);
    const Radiosity E = system.E;
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) {
            system.E[p] = system.rho[p] * system.direct[p];
            B[p] -= E[p];
        }
    solve_gathering(system, B, {.tolerance = 1e-9});
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) B[p] += E[p];
    return B;
}

/// Relative L2 error of the reflected part.
double error(const Room& room, const Radiosity& B, const Radiosity& reference)
{
    double wrong = 0, all = 0;
    for (const PatchId p : room.mesh.patches()) {
        const Rgb E = room.scene.material_of(room.mesh.surface(p)).emission;
        const Rgb d = B[p] - reference[p], R = reference[p] - E;
        wrong += room.mesh.area(p) * glm::dot(d, d);
        all += room.mesh.area(p) * glm::dot(R, R);
    }
    return std::sqrt(wrong / all);
}

/// A table of tolerances and errors against the dense answer.
void expect_convergence(const char* name, const Room& room)
{
    const Radiosity reference = dense(room);
    std::printf("%s, %zu patches\n tolerance  estimated      error      links       rays\n", name,
                room.mesh.patch_count());
    double before = 1;
    for (const double tolerance : {0.16, 0.04, 0.01, 0.0025}) {
        const Linked found = linked(room, tolerance);
        const double wrong = error(room, found.B, reference);
        std::printf("%10.4f %10.4f %10.5f %10zu %10zu\n", tolerance, found.solution.link_error, wrong,
                    found.solution.report.links, found.solution.rays);
        // The estimate leaves out that errors are reflected on, which is less than 1/(1 − .75), and what it takes for
        // correlated is a measured quarter: within three.
        EXPECT_LT(wrong, 3 * tolerance);
        EXPECT_LT(wrong, before);
        before = wrong;
    }
    EXPECT_LT(before, 5e-3);  // no plateau
}

// Issue 5: the dense answer as the tolerance goes to 0.
TEST(Hierarchical, ConvergesToTheDenseAnswer)
{
    expect_convergence("Cornell box, reflected light on links", Room(read("cornell-box.obj", 1e-3), 600, true));
    expect_convergence("Cornell box, all light on links", Room(read("cornell-box.obj", 1e-3), 600, false));
}

// A tenth of a percent that each exchange makes is a tenth of all where light comes round a hundred times.
TEST(Hierarchical, InBrightRoomsTheToleranceHoldsForTheAnswerOrItSaysNo)
{
    for (const double rho : {0.9, 0.99, 0.999, 0.9999}) {
        const Room room(
            cube_inside({0, 0, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(rho), .emission = Rgb(1 - rho)}}), 300,
            false);
        const Linked found = linked(room, 0.04);
        double mean = 0, area = 0;
        for (const PatchId p : room.mesh.patches()) {
            mean += room.mesh.area(p) * found.B[p].g;
            area += room.mesh.area(p);
        }
        std::printf("reflectance %.4f: B %.4f of 1, links %zu, %s\n", rho, mean / area, found.solution.report.links,
                    found.solution.report.converged ? "converged" : "not converged");
        // Every patch absorbs alike, so the mean is all that imbalance knows of; and a tenth is the linear solve's.
        if (found.solution.report.converged) {
            EXPECT_NEAR(mean / area, 1, 1.1 * 0.04) << rho;
        } else {
            EXPECT_GT(rho, 0.995);
        }
    }
}

// Boxes that touch, cross and hang: the mesh is cut along contact lines, nodes have patches of all shapes.
TEST(Hierarchical, ConvergesToTheDenseAnswerAmongRandomBoxes)
{
    for (const std::uint64_t seed : {3U, 8U, 21U}) {
        SCOPED_TRACE(seed);
        const Room room(testing::random_boxes(seed), 300, false);
        const Radiosity reference = dense(room);
        EXPECT_LT(error(room, linked(room, 1e-3).B, reference), 5e-3);
    }
}

// reference-values.md §4. What is missing from a row is missing from B at ρ = .7 3.3 times.
TEST(Hierarchical, FurnaceIsUniform)
{
    const Room room(read("furnace.obj"), 1500, false);
    ASSERT_TRUE(room.scene.closed);
    const Material& m = room.scene.materials.front();
    const double B = m.emission.r / (1 - m.reflectance.r);
    const Linked found = linked(room, 0.002);
    double squares = 0, area = 0;
    for (const PatchId p : room.mesh.patches()) {
        squares += room.mesh.area(p) * std::pow(found.B[p].r / B - 1, 2);
        area += room.mesh.area(p);
        EXPECT_NEAR(found.B[p].r / B, 1, 0.06) << p.value;
    }
    EXPECT_LT(std::sqrt(squares / area), 0.006);
    EXPECT_NEAR(found.solution.energy.relative_residual, 0, 0.006);
}

// §4: closed, uniform ρ: the area mean of B is mean(E)/(1 − ρ), whatever emits. At ρ = .9 rows' errors count tenfold.
TEST(Hierarchical, MeanOfAClosedCubeIsTheClosedForm)
{
    const double rho = 0.9;
    const Room room(
        cube_inside({0, 1, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(rho)},
                                         {.name = "lamp", .reflectance = Rgb(rho), .emission = Rgb(8, 4, 2)}}),
        1000, false);
    const Linked found = linked(room, 0.002);
    Rgb mean(0.0);
    for (const PatchId p : room.mesh.patches()) mean += room.mesh.area(p) / 24 * found.B[p];
    for (int band = 0; band < 3; ++band) {
        const double expected = Rgb(8, 4, 2)[band] / 6 / (1 - rho);
        EXPECT_NEAR(mean[band] / expected, 1, 0.01) << band;
    }
    EXPECT_TRUE(found.solution.report.converged);
    EXPECT_NEAR(found.solution.energy.relative_residual, 0, 0.01);
}

/// Two rooms beside each other with a wall between; light in the first.
Scene two_rooms()
{
    Scene scene = cube_inside({0, 1, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(0.7)},
                                                   {.name = "lamp", .reflectance = Rgb(0.5), .emission = Rgb(5.0)}});
    const Scene other = cube_inside({0, 0, 0, 0, 0, 0}, scene.materials);
    for (const Surface& surface : other.surfaces) {
        std::vector<Vec3> corners;
        for (const std::uint32_t v : surface.loops.front()) corners.push_back(other.vertices[v] + Vec3(2.5, 0, 0));
        testing::add_surface(scene, corners, 0);
    }
    return scene;
}

TEST(Hierarchical, WhatIsHiddenGetsNoLight)
{
    const Room room(two_rooms(), 800, false);
    const Linked found = linked(room, 0.02);
    for (const PatchId p : room.mesh.patches()) {
        if (room.mesh.centroid(p).x < 1.1)
            EXPECT_GT(found.B[p].r, 0) << p.value;
        else
            EXPECT_EQ(found.B[p], Rgb(0.0)) << p.value;
    }
}

// Each link carries light both ways: Σ A_i x_i (F y)_i = Σ A_i y_i (F x)_i but for rounding, however coarse the links.
TEST(Links, AreReciprocal)
{
    const Room room(read("cornell-box.obj", 1e-3), 600, false);
    const PatchHierarchy tree = patch_hierarchy(room.scene, room.mesh);
    const NodeExchange exchange(room.scene, room.caster, room.mesh, tree, 1);
    LinkOperator links(tree, exchange);
    NodeLight light;
    light.rho.assign(tree.nodes.size(), 1.0F);
    links.pull(Radiosity(room.mesh.patch_count(), Rgb(1.0)), light);
    links.refine(light, 1e-6);
    links.sort_links();
    RandomNumbers random(1, 1);
    Radiosity x(room.mesh.patch_count()), y = x, Fx = x, Fy = x;
    for (const PatchId p : room.mesh.patches()) {
        x[p] = Rgb(random.uniform());
        y[p] = Rgb(random.uniform());
    }
    links.gather(x, Fx);
    links.gather(y, Fy);
    double xFy = 0, yFx = 0;
    for (const PatchId p : room.mesh.patches()) {
        xFy += room.mesh.area(p) * x[p].r * Fy[p].r;
        yFx += room.mesh.area(p) * y[p].r * Fx[p].r;
    }
    EXPECT_GT(xFy, 0);
    EXPECT_NEAR(xFy / yFx, 1, 1e-12);
    EXPECT_EQ(sizeof(Link), 20U);
}

TEST(Hierarchical, OnePatchAndNoLight)
{
    Scene alone;
    alone.objects = {"one"};
    alone.materials = {{.name = "lamp", .reflectance = Rgb(0.5), .emission = Rgb(1.0)}};
    testing::add_surface(alone, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0);
    alone.diameter = std::sqrt(2.0);
    const Room one(std::move(alone), 1, false);
    ASSERT_EQ(one.mesh.patch_count(), 1U);
    for (const PatchId p : one.mesh.patches()) EXPECT_EQ(linked(one, 0.05).B[p], Rgb(1.0));

    const Room dark(cube_inside({0, 0, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(0.7)}}), 200, false);
    const Linked found = linked(dark, 0.05);
    EXPECT_TRUE(found.solution.report.converged);
    EXPECT_EQ(found.solution.rays, 0U);
    for (const PatchId p : dark.mesh.patches()) EXPECT_EQ(found.B[p], Rgb(0.0));

    const Room black(cube_inside({0, 1, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(0.0)},
                                                      {.name = "lamp", .reflectance = Rgb(0.0), .emission = Rgb(1.0)}}),
                     200, false);
    EXPECT_EQ(linked(black, 0.05).B, emittance(black.scene, black.mesh));
}

TEST(Hierarchical, IsTheSameForAnyNumberOfThreads)
{
    const Room room(read("cornell-box.obj", 1e-3), 600, true);
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        return linked(room, 0.05);
    };
    const Linked one = with_threads(1), four = with_threads(4);
    EXPECT_EQ(one.B, four.B);
    EXPECT_EQ(one.solution.report.links, four.solution.report.links);
    EXPECT_EQ(one.solution.energy.escaped, four.solution.energy.escaped);
}

TEST(Hierarchical, StopRequestsAreObeyed)
{
    const Room room(read("cornell-box.obj", 1e-3), 600, false);
    std::stop_source stop;
    int told = 0;
    WorkMonitor monitor{stop.get_token(), [&](const WorkState&) {
                            if (++told == 3) stop.request_stop();
                        }};
    EXPECT_THROW(linked(room, 1e-3, monitor), Interrupted);
}

// Light that really arrives is found right, and a fifth too much by its size and sign, within four standard errors.
TEST(Hierarchical, ChecksMeasureWhatIsWrong)
{
    const Room room(read("cornell-box.obj", 1e-3), 600, false);
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    const FormFactorMatrix F = form_factor_matrix(room.scene, room.caster, room.mesh, room.locator, options, {});
    const RadiositySystem system = unassembled(room.exchange());
    RandomNumbers random(3, 1);
    Radiosity X = system.E, H = X;
    for (const PatchId p : room.mesh.patches()) X[p] = Rgb(0.5 + random.uniform());
    rows_of(F)(X, H);
    const LinkCheck right = check_links(room.exchange(), system.rho, X, H, 1'000'000, 1);
    EXPECT_LT(right.at_least(), std::sqrt(2 * right.uncertainty));
    EXPECT_NEAR(right.bias, 0, 0.004);  // a thousandth of noise
    for (const PatchId p : room.mesh.patches()) H[p] *= 1.2;
    const LinkCheck wrong = check_links(room.exchange(), system.rho, X, H, 1'000'000, 1);
    EXPECT_NEAR(wrong.error * wrong.error, 1 / 36.0, 4 * wrong.uncertainty);
    EXPECT_NEAR(wrong.bias, 1 / 6.0, 0.004);
}

// Issue 5 allows a thousandth of n² in a scene of 6,000 polygons; this one has half of that. At 10 %.
TEST(Hierarchical, LinksAreFewInALargeHall)
{
    const Room room(read("gallery.obj"), 20000, true);
    const Linked found = linked(room, 0.1);
    const auto n = static_cast<double>(room.mesh.patch_count());
    const auto links = static_cast<double>(found.solution.report.links);
    std::printf("%g patches, %g links, %.4f %% of n2\n", n, links, 100 * links / n / n);
    EXPECT_LT(links, 1e-3 * n * n);
    EXPECT_LT(found.solution.link_error, 0.1);
}

}  // namespace
}  // namespace patchlight
