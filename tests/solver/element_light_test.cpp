#include "solver/element_light.h"

#include "solver/gather.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <random>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

Rgb quadratic(const Vec3& p)
{
    return {3 + p.x - 2 * p.y + 4 * p.x * p.x - p.x * p.y + p.y * p.y, 1 + p.x * p.y, 5 - p.x * p.x};
}

struct Nodes {
    Scene scene = floor_and_lamp();
    PatchMesh mesh = grid_mesh(scene, 3);
    PatchLocator locator{mesh};
    VertexRadiosity vertex_B{mesh.vertex_count()};
    MidpointRadiosity middle_B{mesh.patch_count()};

    explicit Nodes(Rgb (*f)(const Vec3&))
    {
        for (const VertexId v : mesh.vertices()) vertex_B[v] = f(mesh.position(v));
        for (const PatchId p : mesh.patches()) {
            const auto c = mesh.corners(p);
            for (std::size_t k = 0; k < 3; ++k)
                middle_B[p][k] = f(0.5 * (mesh.position(c[k]) + mesh.position(c[(k + 1) % 3])));
        }
    }
    ElementLight light() const { return {mesh, locator, vertex_B, &middle_B}; }
};

TEST(ElementLight, QuadraticElementsHoldQuadraticFunctionsExactly)
{
    const Nodes nodes(quadratic);
    const PlaneFrame& frame = nodes.scene.surface(SurfaceId(0)).frame;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    double linear_error = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p(unit(random), unit(random), 0);
        const Rgb known = quadratic(p), found = nodes.light().at(SurfaceId(0), frame.to_plane(p));
        const Rgb linear = ElementLight{nodes.mesh, nodes.locator, nodes.vertex_B}.at(SurfaceId(0), frame.to_plane(p));
        // A point beside an edge in the last bit of a float is clamped into its neighbour.
        for (int band = 0; band < 3; ++band) EXPECT_NEAR(found[band], known[band], 1e-6);
        linear_error = std::max(linear_error, std::abs(linear.r - known.r));
    }
    EXPECT_GT(linear_error, 0.05) << "which linear ones don't";
}

TEST(ElementLight, QuadraticElementsTakeTheNodesOwnValues)
{
    const Nodes nodes(quadratic);
    for (const PatchId p : nodes.mesh.patches()) {
        const auto c = nodes.mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 a = nodes.mesh.plane_position(c[k]), b = nodes.mesh.plane_position(c[(k + 1) % 3]);
            EXPECT_NEAR(nodes.light().at(p, a).r, nodes.vertex_B[c[k]].r, 1e-12);
            EXPECT_NEAR(nodes.light().at(p, 0.5 * (a + b)).r, nodes.middle_B[p][k].r, 1e-12);
        }
    }
}

TEST(ElementLight, NeverBelowZero)
{
    // 1 at one node and 0 at all others: the polynomial of a corner goes down to -1/8.
    Nodes nodes([](const Vec3&) { return Rgb(0.0); });
    const PatchId p(0);
    nodes.vertex_B[nodes.mesh.corners(p)[0]] = Rgb(1.0);
    const auto c = nodes.mesh.corners(p);
    const Vec2 a = nodes.mesh.plane_position(c[0]), b = nodes.mesh.plane_position(c[1]);
    EXPECT_EQ(nodes.light().at(p, 0.25 * a + 0.75 * b), Rgb(0.0));
    EXPECT_GT(nodes.light().at(p, 0.75 * a + 0.25 * b).r, 0.3);
}

TEST(Reconstruct, QuadraticElementsKeepTheVerticesOfLinearOnesAndAgreeAlongEdges)
{
    const Scene scene = floor_and_lamp();
    const PatchMesh mesh = grid_mesh(scene, 4);
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    const auto direct = emitters_light(scene);
    const Exchange exchange{scene, caster, mesh, locator, &*direct};
    const Radiosity B = emittance(scene, mesh);
    const LightAtPoints light = light_from_patches(exchange, B, {.rays = 16});
    const Reconstruction linear = reconstruct(exchange, light, 30);
    const Reconstruction both = reconstruct(exchange, light, 30, {}, Elements::quadratic);
    EXPECT_TRUE(linear.middle_B.empty());
    EXPECT_EQ(both.B, linear.B);
    DirectLight::Scratch scratch;
    for (const PatchId p : mesh.patches_of(SurfaceId(0))) {
        const auto across = mesh.neighbours(p);
        const auto c = mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 middle = 0.5 * (mesh.position(c[k]) + mesh.position(c[(k + 1) % 3]));
            // ρ = .5; nothing else reflects, so that direct light is all. Borders are gathered a millionth inside.
            const Rgb H = direct_irradiance(scene, *direct, middle, SurfaceId(0), scratch);
            EXPECT_NEAR(both.middle_B[p][k].r, 0.5 * H.r, 1e-5 * H.r);
            if (!across[k].valid()) continue;
            const auto back = mesh.neighbours(across[k]);
            const auto at = static_cast<std::size_t>(std::find(back.begin(), back.end(), p) - back.begin());
            EXPECT_EQ(both.middle_B[p][k], both.middle_B[across[k]][at]);
        }
    }
}

}  // namespace
}  // namespace patchlight
