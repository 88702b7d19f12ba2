// What must hold of any solution, whatever the mesh: furnace, energy, invariance, determinism.
#include "meshing/read_scene.h"
#include "solver/adaptive.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace patchlight {
namespace {

using testing::cube_inside;

AdaptiveOptions quick(std::size_t elements)
{
    AdaptiveOptions options;
    options.max_elements = elements;
    options.form_factors.rays = 256;
    options.gather.rays = 256;
    return options;
}

// reference-values.md §4: closed, uniform E and ρ: B = E/(1 − ρ) everywhere. Only the linear solver's tolerance
// (1e-4 of the total) and single precision of the factors stand in between.
TEST(Furnace, NonConvexRotatedRoomIsUniform)
{
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/furnace.obj").scene;
    ASSERT_TRUE(scene.closed);
    const Material& m = scene.materials.front();
    ASSERT_NEAR(m.reflectance.r, 0.7, 1e-12);
    const double B = m.emission.r / (1 - m.reflectance.r);
    const AdaptiveSolution solution = solve_adaptively(scene, quick(1500));
    for (const PatchId p : solution.mesh.patches()) EXPECT_NEAR(solution.B[p].r / B, 1, 1e-3) << p.value;
    for (const VertexId v : solution.mesh.vertices()) EXPECT_NEAR(solution.vertex_B[v].r / B, 1, 1e-3) << v.value;
    EXPECT_NEAR(solution.energy.relative_residual, 0, 5e-3);
}

Scene lamp_cube(double rho)
{
    Scene scene =
        cube_inside({0, 0, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(rho)},
                                         {.name = "lamp", .reflectance = Rgb(rho), .emission = Rgb(8, 4, 2)}});
    // The lamp hangs a little below the ceiling, with a black back: the room stays closed but for the gap above it.
    const double z = 1 - 1e-3;
    testing::add_surface(scene, {{-.2, -.2, z}, {-.2, .2, z}, {.2, .2, z}, {.2, -.2, z}}, 1);
    return scene;
}

/// A lamp flush with the ceiling: the ceiling's middle is the lamp. Eight more pieces of ceiling around it.
Scene flush_lamp_cube(double rho)
{
    Scene scene =
        cube_inside({0, 0, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(rho)},
                                         {.name = "lamp", .reflectance = Rgb(rho), .emission = Rgb(8, 4, 2)}});
    scene.surfaces.erase(scene.surfaces.begin() + 1);
    std::erase_if(scene.triangles, [](const SceneTriangle& t) { return t.front == SurfaceId(1UL); });
    for (SceneTriangle& t : scene.triangles)
        if (t.front.value > 1) --t.front.value;
    const std::array<double, 4> cut{-1, -.2, .2, 1};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            testing::add_surface(
                scene,
                {{cut[i], cut[j], 1}, {cut[i], cut[j + 1], 1}, {cut[i + 1], cut[j + 1], 1}, {cut[i + 1], cut[j], 1}},
                i == 1 && j == 1 ? 1 : 0);
    return scene;
}

/// §4: closed, uniform ρ: the area mean of B is mean(E)/(1 − ρ) exactly.
void expect_closed_form_mean(const AdaptiveSolution& solution, double rho, double tolerance)
{
    Rgb mean(0.0);
    double area = 0;
    for (const PatchId p : solution.mesh.patches()) {
        mean += solution.mesh.area(p) * solution.B[p];
        area += solution.mesh.area(p);
    }
    mean /= area;
    EXPECT_NEAR(area, 24, 1e-9);
    const Rgb expected = 0.16 / 24 * Rgb(8, 4, 2) / (1 - rho);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(mean[band] / expected[band], 1, tolerance) << band;
    EXPECT_NEAR(solution.energy.relative_residual, 0, tolerance);
}

// Sampled rows aren't reciprocal, so that chance remains: half a percent of it at 512 rays a patch.
TEST(Cube, AreaMeanOfBIsTheClosedForm)
{
    AdaptiveOptions options = quick(3000);
    options.form_factors.rays = 512;
    const AdaptiveSolution solution = solve_adaptively(flush_lamp_cube(0.5), options);
    expect_closed_form_mean(solution, 0.5, 5e-3);
    EXPECT_EQ(solution.energy.escaped, 0);
}

// Exact rows are reciprocal and closed to 1e-6: what is left is the linear solver's tolerance. The emitter's light
// comes by its rows, too: exact direct light is exact at points, and three of them stand for a patch.
TEST(Cube, AreaMeanOfBByExactFactors)
{
    AdaptiveOptions options = quick(600);
    options.refine = Refine::none;
    options.meshing.max_elements = 600;
    options.form_factors.method = FormFactorMethod::exact;
    options.direct = Direct::sampled;
    options.final.tolerance = 1e-9;
    expect_closed_form_mean(solve_adaptively(flush_lamp_cube(0.9), options), 0.9, 1e-5);
}

TEST(Solution, RadiosityIsNeverBelowEmissionNorNotANumber)
{
    const Scene scene = lamp_cube(0.7);
    const AdaptiveSolution solution = solve_adaptively(scene, quick(1500));
    const auto holds = [&](const Rgb& B, SurfaceId surface) {
        const Rgb E = scene.material_of(surface).emission;
        for (int band = 0; band < 3; ++band)
            if (!std::isfinite(B[band]) || B[band] < E[band]) return false;
        return true;
    };
    for (const PatchId p : solution.mesh.patches())
        EXPECT_TRUE(holds(solution.B[p], solution.mesh.surface(p))) << p.value;
    for (const VertexId v : solution.mesh.vertices())
        EXPECT_TRUE(holds(solution.vertex_B[v], solution.mesh.surface(v))) << v.value;
}

/// Relative L2 difference of two solutions on the same mesh.
double difference(const AdaptiveSolution& a, const AdaptiveSolution& b)
{
    double num = 0, den = 0;
    EXPECT_EQ(a.mesh.vertex_count(), b.mesh.vertex_count());
    if (a.mesh.vertex_count() != b.mesh.vertex_count()) return 1;
    for (const PatchId p : a.mesh.patches())
        for (const VertexId v : a.mesh.corners(p)) {
            const Rgb d = a.vertex_B[v] - b.vertex_B[v];
            num += a.mesh.area(p) * glm::dot(d, d);
            den += a.mesh.area(p) * glm::dot(a.vertex_B[v], a.vertex_B[v]);
        }
    return std::sqrt(num / den);
}

SceneOptions in_millimetres()
{
    SceneOptions options;
    options.unit = 1e-3;
    return options;
}

/// A copy of an OBJ with all vertices moved.
std::filesystem::path shifted_obj(const std::filesystem::path& obj, double shift)
{
    const auto folder = std::filesystem::path(::testing::TempDir());
    auto mtl = obj;
    mtl.replace_extension(".mtl");
    std::filesystem::copy_file(mtl, folder / mtl.filename(), std::filesystem::copy_options::overwrite_existing);
    std::ifstream in(obj);
    std::ofstream out(folder / "shifted.obj");
    out.precision(17);
    for (std::string line; std::getline(in, line);) {
        Vec3 v;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3)
            out << "v " << v.x + shift << ' ' << v.y - shift << ' ' << v.z + shift << '\n';
        else
            out << line << '\n';
    }
    return folder / "shifted.obj";
}

// The same triangles come out at any scale and place; rays that graze a silhouette may fall to the other side.
TEST(Solution, ScaleAndShiftDoNotMatter)
{
    AdaptiveOptions options = quick(2000);
    options.refine = Refine::none;
    options.meshing.max_elements = 2000;
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", in_millimetres()).scene;
    const AdaptiveSolution solution = solve_adaptively(scene, options);
    for (const double scale : {1e-3, 1e3}) {
        SceneOptions other = in_millimetres();
        other.unit *= scale;
        const Scene scaled = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", other).scene;
        EXPECT_LT(difference(solution, solve_adaptively(scaled, options)), 1e-3) << scale;
    }
    const Scene shifted =
        read_scene(shifted_obj(PATCHLIGHT_DATA "/scenes/cornell-box.obj", 1e4 * 958.9), in_millimetres()).scene;
    EXPECT_LT(difference(solution, solve_adaptively(shifted, options)), 1e-3);
}

/// Radiosity has no length in it, and powers of two none to round: no decision may fall otherwise, no ray go elsewhere.
TEST(Solution, PowersOfTwoInSizeChangeNoBit)
{
    SceneOptions sized = in_millimetres();
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", sized).scene;
    const AdaptiveSolution solution = solve_adaptively(scene, quick(1500));
    for (const int power : {-49, -20, 20, 49}) {
        sized.unit = std::ldexp(1e-3, power);
        const Scene other_scene = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", sized).scene;
        const AdaptiveSolution other = solve_adaptively(other_scene, quick(1500));
        EXPECT_EQ(solution.mesh.arrays().triangles, other.mesh.arrays().triangles) << power;
        EXPECT_EQ(solution.B, other.B) << power;
        EXPECT_EQ(solution.vertex_B, other.vertex_B) << power;
        EXPECT_EQ(std::ldexp(solution.error.total, power), other.error.total) << power;
    }
}

TEST(Solution, PowersOfTwoInLightChangeNoOtherBit)
{
    Scene scene = lamp_cube(0.5);
    const AdaptiveSolution solution = solve_adaptively(scene, quick(800));
    for (const int power : {-60, 60}) {
        Scene other_scene = scene;
        for (Material& m : other_scene.materials) m.emission *= std::ldexp(1.0, power);
        const AdaptiveSolution other = solve_adaptively(other_scene, quick(800));
        EXPECT_EQ(solution.mesh.arrays().triangles, other.mesh.arrays().triangles) << power;
        ASSERT_EQ(solution.vertex_B.size(), other.vertex_B.size()) << power;
        for (std::size_t v = 0; v < other.vertex_B.size(); ++v)
            EXPECT_EQ(std::ldexp(1.0, power) * solution.vertex_B[VertexId(v)], other.vertex_B[VertexId(v)]) << power;
    }
}

bool same(const AdaptiveSolution& a, const AdaptiveSolution& b)
{
    return a.B == b.B && a.vertex_B == b.vertex_B && a.error.eta == b.error.eta &&
           a.mesh.arrays().positions == b.mesh.arrays().positions &&
           a.mesh.arrays().triangles == b.mesh.arrays().triangles;
}

TEST(Solution, IsTheSameForAnyNumberOfThreads)
{
    const Scene scene = lamp_cube(0.5);
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        return solve_adaptively(scene, quick(1500));
    };
    const AdaptiveSolution one = with_threads(1);
    EXPECT_TRUE(same(one, with_threads(2)));
    EXPECT_TRUE(same(one, with_threads(4)));
}

TEST(Solution, ResumedAfterAnyCycleEndsTheSame)
{
    const Scene scene = lamp_cube(0.5);
    std::vector<AdaptiveStart> stored;
    AdaptiveObservers observers;
    observers.on_step = [&](const AdaptiveStep& step) {
        if (step.stage == Stage::final) return;
        stored.push_back({step.cycle, PatchMesh(scene, step.mesh.arrays()), step.B, step.error});
    };
    const AdaptiveSolution whole = solve_adaptively(scene, quick(3000), observers);
    ASSERT_GE(stored.size(), 2U);
    for (AdaptiveStart& start : stored) {
        const int cycle = start.cycle;
        EXPECT_TRUE(same(whole, solve_adaptively(scene, quick(3000), {}, std::move(start)))) << "after cycle " << cycle;
    }
}

TEST(Solution, StopRequestsAreObeyed)
{
    const Scene scene = lamp_cube(0.5);
    std::stop_source stop;
    AdaptiveObservers observers;
    observers.stop = stop.get_token();
    int steps = 0;
    observers.on_step = [&](const AdaptiveStep&) {
        if (++steps == 2) stop.request_stop();
    };
    EXPECT_THROW(solve_adaptively(scene, quick(100000), observers), Interrupted);
    EXPECT_EQ(steps, 2);
}

}  // namespace
}  // namespace patchlight
