// The path tracer of `verify` beside closed forms and beside the reference, which shares no code with it.
#include "apps/verification/path_tracer.h"

#include "tests/meshing/written_scene.h"
#include "tests/verification/path_traced_reference_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace patchlight {
namespace {

using testing::box;
using testing::load;
using testing::read_text;
using testing::rectangle;
using testing::room_with_lamp;
using testing::with;

struct Found {
    Rgb mean{0.0}, standard_error{0.0};
};

/// B − E at a point from 16 streams of paths.
Found trace(const Scene& scene, const DrawnPoint& point, std::uint32_t paths, std::optional<FindEmitters> emitters = {})
{
    const RayCaster caster(scene);
    const PathTracer tracer(scene, caster, 1, emitters);
    PathTracer::Scratch scratch;
    constexpr int streams = 16;
    std::vector<Rgb> sums(streams, Rgb(0.0));
    Found found;
    for (std::uint64_t k = 0; k < streams; ++k) {
        tracer.add_paths(point, k, 0, paths, sums[k], scratch);
        sums[k] /= static_cast<double>(paths);
        found.mean += sums[k] / static_cast<double>(streams);
    }
    for (const Rgb& sum : sums) found.standard_error += (sum - found.mean) * (sum - found.mean);
    found.standard_error = glm::sqrt(found.standard_error / static_cast<double>(streams * (streams - 1)));
    return found;
}

/// Five standard errors of 16 streams: a false alarm in some 6,000 values, and the seed is fixed. `slack` is for single
/// precision and for values without spread.
void expect_near(const Found& found, const Rgb& expected, const Rgb& its_error = Rgb(0.0))
{
    for (int band = 0; band < 3; ++band) {
        const double slack = 1e-6 * std::abs(expected[band]);
        EXPECT_NEAR(found.mean[band], expected[band],
                    5 * std::hypot(found.standard_error[band], its_error[band]) + slack);
    }
}

/// The point's surface is the one that a short way down along `normal` meets: several may lie in one plane.
DrawnPoint point_of(const Scene& scene, const Vec3& in_file, const Vec3& normal)
{
    const Vec3 p = in_file * scene.unit - scene.center;
    RayBatch ray;
    ray.resize(1);
    ray.set(0, p + 1e-4 * scene.diameter * normal, -normal, 1e6F);
    HitBatch hit;
    RayCaster(scene).closest(ray, hit);
    return {SurfaceId(hit.surface[0]), p};
}

TEST(SurfaceSampler, TrianglesCoverEachSurfaceOnceAndAreDrawnUniformly)
{
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/furniture-room.obj").scene;
    const SurfaceSampler sampler = reflecting_surface(scene);
    double area = 0;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).reflects()) area += scene.surfaces[s].area;
    EXPECT_NEAR(sampler.total(), area, 1e-9 * area);
    constexpr std::size_t n = 20000;
    std::vector<std::size_t> hits(scene.surfaces.size());
    for (const DrawnPoint& p : draw_points(sampler, n, 1)) {
        ++hits[p.surface.value];
        const PlaneFrame& frame = scene.surface(p.surface).frame;
        EXPECT_LT(std::abs(glm::dot(p.position - frame.origin, frame.n)), 1e-7 * scene.diameter);
    }
    for (std::size_t s = 0; s < hits.size(); ++s) {
        // Stratified over the area: each of a surface's triangles is off by two at most.
        const double expected = static_cast<double>(n) * sampler.density(SurfaceId(s)) * scene.surfaces[s].area;
        EXPECT_NEAR(static_cast<double>(hits[s]), expected, 2 * (1 + std::sqrt(expected)));
    }
}

TEST(PathTracer, FurnaceHasTheSameLightEverywhereHoweverEmittersAreFound)
{
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/furnace.obj").scene;
    const Material& m = scene.materials.front();
    const Rgb expected = m.reflectance * m.emission / (1.0 - m.reflectance);
    for (const DrawnPoint& p : draw_points(reflecting_surface(scene), 6, 3)) {
        expect_near(trace(scene, p, 512), expected);
        expect_near(trace(scene, p, 512, FindEmitters::drawn), expected);
    }
}

TEST(PathTracer, EmissionIsCountedOnceWhetherDrawnOrMetByChance)
{
    const Scene scene = load(room_with_lamp()).scene;
    for (const DrawnPoint& p : draw_points(reflecting_surface(scene), 8, 4)) {
        const Found chance = trace(scene, p, 8192, FindEmitters::by_chance);
        expect_near(trace(scene, p, 2048, FindEmitters::drawn), chance.mean, chance.standard_error);
    }
}

// reference-values.md §4: closed, uniform ρ, any emitters: the area mean of B is mean(E)/(1 − ρ). A lamp of a twentieth
// of the surface, which reflects as the walls do.
TEST(PathTracer, AClosedRoomKeepsItsPower)
{
    const std::string mtl = "newmtl white\nKd .6 .4 .2\nnewmtl lamp\nKd .6 .4 .2\nKe 3 2 1\n";
    const Scene scene = read_text(testing::obj_text(room_with_lamp()), {}, mtl).scene;
    ASSERT_TRUE(scene.closed);
    const Rgb rho{.6, .4, .2};
    const Rgb mean_E = std::acos(-1) * Rgb{3, 2, 1} / (2 * 16 + 4 * 12.0);
    const RayCaster caster(scene);
    const PathTracer tracer(scene, caster, 5);
    PathTracer::Scratch scratch;
    const auto points = draw_points(reflecting_surface(scene), 4096, 6);
    Found found;
    std::vector<Rgb> values(points.size(), Rgb(0.0));
    for (std::size_t i = 0; i < points.size(); ++i) {
        tracer.add_paths(points[i], i, 0, 16, values[i], scratch);
        found.mean += values[i] / (16.0 * 4096);
    }
    for (const Rgb& v : values) found.standard_error += (v / 16.0 - found.mean) * (v / 16.0 - found.mean);
    found.standard_error = glm::sqrt(found.standard_error / (4096.0 * 4095));
    expect_near(found, rho * mean_E / (1.0 - rho));
    EXPECT_LT(found.standard_error.r, 0.02 * found.mean.r) << "else nothing was tested";
}

TEST(PathTracer, AgreesWithTheIndependentReferenceInTheCornellBox)
{
    const std::string file = PATCHLIGHT_DATA "/scenes/cornell-box.obj";
    SceneOptions options;
    options.unit = 1e-3;
    const Scene scene = read_scene(file, options).scene;
    const reference::ReferenceScene known = reference::read_reference_scene(file);
    const auto points = reference::sample_points(known, 12, 8);
    std::size_t lit = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const reference::Polygon& polygon = known.polygons()[points[k].polygon];
        const DrawnPoint point = point_of(scene, points[k].position, polygon.n);
        ASSERT_TRUE(point.surface.valid());
        const reference::Measured H =
            measure_irradiance(known, points[k].position, polygon.n,
                               {.replicates = 16, .light_strata = 8, .direction_strata = 24}, k)
                .total;
        if (H.mean.g == 0) continue;  // covered by a block
        ++lit;
        expect_near(trace(scene, point, 2048), polygon.rho * H.mean, polygon.rho * H.standard_error);
    }
    EXPECT_GE(lit, 10U);
}

// A tiny piece of floor below the middle of a unit square 1 m above, and one as far above it, which the square hides
// from one another. reference-values.md §1: F = 0.23945647046077353883.
TEST(PathTracer, ATwoSidedPlateLightsBothSidesAndAOneSidedItsFront)
{
    const double e = 1e-4;
    const auto plate = rectangle({-.5, -.5, 1}, {0, 1, 0}, {1, 0, 0}, "lamp", "plate");  // faces down
    const auto below = rectangle({-e, -e, 0}, {2 * e, 0, 0}, {0, 2 * e, 0});
    const auto above = rectangle({-e, -e, 2}, {0, 2 * e, 0}, {2 * e, 0, 0});
    const Rgb lit = .7 * .23945647046077353883 * std::acos(-1) * 10 * Rgb(1);
    for (const bool two_sided : {false, true}) {
        SceneOptions options;
        if (two_sided) options.two_sided = {"lamp"};
        const Scene scene = load({plate, below, above}, options).scene;
        expect_near(trace(scene, point_of(scene, {0, 0, 0}, {0, 0, 1}), 1024), lit);
        const Found top = trace(scene, point_of(scene, {0, 0, 2}, {0, 0, -1}), 1024);
        if (two_sided)
            expect_near(top, lit);
        else
            EXPECT_EQ(top.mean, Rgb(0.0)) << "a back is black";
    }
}

TEST(PathTracer, ALampLaidOnACeilingLightsAsOneLetIn)
{
    const Scene let_in = load(room_with_lamp()).scene;
    const auto whole =
        with(box({0, 0, 0}, {4, 4, 3}, true), rectangle({1, 1, 3}, {0, 1, 0}, {1, 0, 0}, "lamp", "lamp"));
    const Scene laid_on = load(whole).scene;
    for (const Vec3& p : {Vec3{.3, 1.2, 0}, Vec3{2, 3.1, 0}}) {
        const Found known = trace(let_in, point_of(let_in, p, {0, 0, 1}), 2048);
        expect_near(trace(laid_on, point_of(laid_on, p, {0, 0, 1}), 2048), known.mean, known.standard_error);
        EXPECT_GT(known.mean.g, 0);
    }
}

TEST(PathTracer, ASealedRoomBesideALitOneIsExactlyDark)
{
    auto rooms = room_with_lamp();
    for (const auto& side : box({5, 0, 0}, {1, 1, 1}, true)) rooms.push_back(side);
    const Scene scene = load(rooms).scene;
    EXPECT_EQ(trace(scene, point_of(scene, {5.4, .3, 0}, {0, 0, 1}), 1024).mean, Rgb(0.0));
}

TEST(PathTracer, WithoutAnEmitterThereIsNoLight)
{
    SceneOptions options;
    options.require_emitter = false;
    const Scene scene = load(box({0, 0, 0}, {1, 1, 1}, true), options).scene;
    EXPECT_EQ(trace(scene, draw_points(reflecting_surface(scene), 1, 1).front(), 64).mean, Rgb(0.0));
}

}  // namespace
}  // namespace patchlight
