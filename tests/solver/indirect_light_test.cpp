// Indirect light on a mesh of its own: closed forms, what is kept and what is traced again, and whether its own account
// of noise is true.
#include "solver/adaptive.h"
#include "solver/light_carrier.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patchlight {
namespace {

using testing::cube_inside;

/// A closed cube, 2 m wide, of which one wall emits and reflects like the others, or all do.
Scene cube(double rho, bool all_emit)
{
    const std::size_t rest = all_emit ? 1 : 0;
    return cube_inside({rest, 1, rest, rest, rest, rest},
                       {{.name = "wall", .reflectance = Rgb(rho)},
                        {.name = "lamp", .reflectance = Rgb(rho), .emission = Rgb(8, 4, 2)}});
}

/// A scene with its mesh, patches solved, ready for indirect light.
struct Solved {
    Scene scene;
    RayCaster caster{scene};
    PatchMesh mesh;
    PatchLocator locator{mesh};
    std::optional<DirectLight> direct{emitters_light(scene)};
    Exchange exchange{scene, caster, mesh, locator, &*direct};
    RadiositySystem system{assemble(exchange, {.rays = 256})};
    Radiosity B{system.E};

    explicit Solved(Scene made) : scene(std::move(made)), mesh(triangulate(scene, {.max_edge = 0.7}))
    {
        RadiositySystem reflected = system;
        for (const PatchId p : mesh.patches()) reflected.E[p] = system.rho[p] * system.direct[p];
        B = reflected.E;
        solve(reflected, B, {.tolerance = 1e-6});
        for (const PatchId p : mesh.patches()) B[p] += system.E[p];
    }

    IndirectLight indirect(const IndirectOptions& options) const
    {
        return solve_indirect({exchange, system, B}, EmittedLight{}, options);
    }
};

std::vector<SurfacePoint> middles_of(const PatchMesh& mesh)
{
    std::vector<SurfacePoint> points;
    for (const PatchId p : mesh.patches()) points.push_back({mesh.centroid(p), mesh.surface(p), mesh.centroid(p)});
    return points;
}

std::vector<std::uint32_t> counted(std::size_t n)
{
    std::vector<std::uint32_t> indices(n);
    for (std::size_t i = 0; i < n; ++i) indices[i] = static_cast<std::uint32_t>(i);
    return indices;
}

QuadraticRadiosity even_light(const PatchMesh& mesh, const Rgb& B)
{
    return {VertexRadiosity(mesh.vertex_count(), B), MidpointRadiosity(mesh.patch_count(), {B, B, B})};
}

// Every ray of a closed room ends on a front, and the factors sum to 1: single precision is all that is lost.
TEST(HitRows, InAClosedRoomEvenLightArrivesWhole)
{
    const Solved cube_of(cube(0.5, false));
    HitRows rows(cube_of.exchange, {.rays = 128});
    const auto points = middles_of(cube_of.mesh);
    rows.add(points);
    for (const Rgb& H : rows.irradiance(counted(points.size()), even_light(cube_of.mesh, Rgb(3, 2, 1))))
        for (int band = 0; band < 3; ++band) EXPECT_NEAR(H[band], 3 - band, 1e-5);
    EXPECT_TRUE(rows.keeps_all());
}

TEST(HitRows, WhatIsTracedAgainIsTheSameToTheBit)
{
    const Solved cube_of(cube(0.5, false));
    const auto points = middles_of(cube_of.mesh);
    QuadraticRadiosity light = even_light(cube_of.mesh, Rgb(1));
    for (const VertexId v : cube_of.mesh.vertices()) light.at_vertices[v] = Rgb(2 + cube_of.mesh.position(v).x);
    HitRows all(cube_of.exchange, {.rays = 64}), none(cube_of.exchange, {.rays = 64, .most_bytes = 0}),
        some(cube_of.exchange, {.rays = 64, .most_bytes = 10'000});
    for (HitRows* rows : {&all, &none, &some}) rows->add(points);
    const auto expected = all.irradiance(counted(points.size()), light);
    EXPECT_EQ(none.irradiance(counted(points.size()), light), expected);
    EXPECT_EQ(some.irradiance(counted(points.size()), light), expected);
    EXPECT_FALSE(none.keeps_all());
    EXPECT_FALSE(some.keeps_all());
    EXPECT_GT(none.rays(), 0U);
    const std::size_t traced = all.rays();
    (void)all.irradiance(counted(points.size()), light);
    EXPECT_EQ(all.rays(), traced) << "a further sweep traces nothing";
}

// §4: all walls alike: H = E/(1 − ρ), of which the emitters' own E arrives directly. 1e-4: of the linear solve, twice
// swept, and of single precision.
TEST(IndirectLight, IsThatOfTheFurnaceEverywhere)
{
    const double rho = 0.6;
    const Solved furnace(cube(rho, true));
    const IndirectLight light = furnace.indirect({.max_elements = 600});
    for (const SurfacePoint& point : middles_of(furnace.mesh)) {
        const Rgb H = light.at(furnace.scene, point);
        for (int band = 0; band < 3; ++band)
            EXPECT_NEAR(H[band], Rgb(8, 4, 2)[band] * rho / (1 - rho), 1e-4 * 8 * rho / (1 - rho));
    }
    EXPECT_LT(light.error(), 1e-3) << "even light has neither noise nor anything for a mesh to miss";
}

// Two solutions by other rays differ by √2 times the noise of each: what light.noise says, within a factor of two, as
// there are six surfaces, each with directions of its own, to average over.
TEST(IndirectLight, ItsNoiseIsWhatOtherRaysMake)
{
    const Solved lit(cube(0.6, false));
    IndirectOptions options{.max_elements = 600, .rays = 64};
    const IndirectLight one = lit.indirect(options);
    options.gather.seed = 17;
    const IndirectLight other = lit.indirect(options);
    double sum = 0;
    for (const SurfacePoint& point : middles_of(lit.mesh)) {
        const Rgb d = 0.6 * (one.at(lit.scene, point) - other.at(lit.scene, point));
        sum += 24.0 / static_cast<double>(lit.mesh.patch_count()) * glm::dot(d, d);
    }
    const double measured = std::sqrt(sum / 2);
    EXPECT_GT(one.noise, 0.5 * measured);
    EXPECT_LT(one.noise, 2 * measured);
}

// More rays, less noise: nets lose it like n^-3/4, 2.8 times for 4; two is asked of the few directions there are.
TEST(IndirectLight, FourTimesTheRaysHalveTheNoise)
{
    const Solved lit(cube(0.6, false));
    const double few = lit.indirect({.max_elements = 600, .rays = 64}).noise;
    const double more = lit.indirect({.max_elements = 600, .rays = 256}).noise;
    EXPECT_LT(more, few / 2);
    EXPECT_GT(more, 0);
}

TEST(IndirectLight, ATargetSetsTheRays)
{
    const Solved lit(cube(0.6, false));
    const IndirectLight rough = lit.indirect({.target_error = 0.05, .max_elements = 4000});
    const IndirectLight fine = lit.indirect({.target_error = 0.01, .max_elements = 4000});
    EXPECT_GT(fine.vertex_rays, 2 * rough.vertex_rays);
    EXPECT_LT(fine.error(), rough.error());
}

// A lamp that shines away from all that reflects: no light, no error, and nothing to divide by.
TEST(IndirectLight, WhereNoLightArrivesThereIsNone)
{
    Scene scene;
    scene.objects = {"o"};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5)}, {.name = "lamp", .emission = Rgb(1)}};
    testing::add_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
    testing::add_surface(scene, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, 1);
    for (const Direct direct : {Direct::exact, Direct::sampled})
        for (const double target : {0.0, 0.01}) {
            AdaptiveOptions options;
            options.direct = direct;
            options.target_error = target;
            options.max_elements = 100;
            const AdaptiveSolution solution = solve_adaptively(scene, options);
            EXPECT_TRUE(solution.converged);
            EXPECT_EQ(solution.error.relative, 0);
            for (const PatchId p : solution.mesh.patches_of(SurfaceId(0))) EXPECT_EQ(solution.B[p], Rgb(0.0));
        }
}

TEST(IndirectLight, CanBeInterrupted)
{
    const Solved lit(cube(0.6, false));
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(solve_indirect({lit.exchange, lit.system, lit.B}, EmittedLight{}, {}, {stop.get_token(), {}}),
                 Interrupted);
}

}  // namespace
}  // namespace patchlight
