#include "meshing/patch_locator.h"

#include "tests/meshing/flat_scenes.h"
#include "tests/meshing/mesh_checks.h"

#include <gtest/gtest.h>

#include <random>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

struct Hits {
    std::vector<std::uint32_t> surface;
    std::vector<float> x, y;

    void add(SurfaceId s, const Vec2& q)
    {
        surface.push_back(s.value);
        x.push_back(static_cast<float>(q.x));
        y.push_back(static_cast<float>(q.y));
    }
    Vec2 at(std::size_t i) const { return {x[i], y[i]}; }
};

/// The smallest barycentric coordinate: negative outside.
double inside(const PatchMesh& mesh, PatchId patch, const Vec2& q)
{
    const auto c = mesh.corners(patch);
    const Vec2 a = mesh.plane_position(c[0]), b = mesh.plane_position(c[1]), d = mesh.plane_position(c[2]);
    return std::min({cross2(q, a, b), cross2(q, b, d), cross2(q, d, a)}) / cross2(a, b, d);
}

bool on_surface(const PatchMesh& mesh, SurfaceId surface, const Vec2& q)
{
    for (const PatchId p : mesh.patches_of(surface)) {
        if (inside(mesh, p, q) >= 0) return true;
    }
    return false;
}

/// Points in randomly drawn patches: small ones as often as large ones. Vertices and middles of edges too.
Hits random_hits(const PatchMesh& mesh, std::size_t count, std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    Hits hits;
    for (std::size_t i = 0; i < count; ++i) {
        const PatchId patch(random() % mesh.patch_count());
        const auto c = mesh.corners(patch);
        double u = unit(random), v = unit(random);
        if (i % 10 == 0) u = v = 0;
        if (i % 10 == 1) v = 0;
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        hits.add(mesh.surface(patch), (1 - u - v) * mesh.plane_position(c[0]) + u * mesh.plane_position(c[1]) +
                                          v * mesh.plane_position(c[2]));
    }
    return hits;
}

void expect_located(const PatchMesh& mesh, const Hits& hits)
{
    const PatchLocator locator(mesh);
    std::vector<PatchId> found(hits.x.size());
    locator.locate(hits.surface, hits.x, hits.y, static_cast<std::uint32_t>(mesh.surface_count()), found);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const SurfaceId surface(std::size_t{hits.surface[i]});
        EXPECT_EQ(found[i], locator.locate(surface, hits.x[i], hits.y[i])) << "many at once and one by one";
        ASSERT_TRUE(found[i].valid());
        ASSERT_EQ(mesh.surface(found[i]), surface);
        // Rounding to float may carry a point off the surface: then the nearest patch will do. Inside, the
        // coordinates are sums of three floats of size 1, each relative to the patch.
        const bool found_it = inside(mesh, found[i], hits.at(i)) >= -1e-5;
        EXPECT_TRUE(found_it || !on_surface(mesh, surface, hits.at(i))) << "point " << i;
    }
}

PatchMesh graded(const Scene& scene, const Vec3& corner)
{
    PatchMesh mesh = triangulate(scene, {.max_edge = 0.3 * scene.diameter});
    for (int round = 0; round < 40; ++round) mesh = refine(scene, mesh, plan_towards(mesh, corner), {}).mesh;
    return mesh;
}

}  // namespace

TEST(PatchLocator, points_are_in_the_patch_found)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons()) {
        SCOPED_TRACE(name);
        const Scene scene = flat_scene(loops, 0.5, tilted_frame());
        const PatchMesh mesh = triangulate(scene, {.max_edge = scene.diameter / 20});
        expect_located(mesh, random_hits(mesh, 2000, seed++));
    }
    const Scene cornell = cornell_box();
    const PatchMesh mesh = triangulate(cornell, {.max_elements = 5000});
    expect_located(mesh, random_hits(mesh, 5000, seed));
}

TEST(PatchLocator, strongly_graded_meshes)
{
    const Scene square = flat_scene({rectangle_loop(0, 0, 1, 1)});
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0.37, 0.59, 0)}) {
        const PatchMesh mesh = graded(square, corner);
        double finest = 1;
        for (const PatchId p : mesh.patches()) finest = std::min(finest, mesh.longest_edge(p));
        EXPECT_LT(finest, 1e-3 * longest_edge(mesh));
        expect_located(mesh, random_hits(mesh, 5000, 7));
    }
}

// The mesh is one square; around it, hits are off by rounding.
TEST(PatchLocator, points_just_outside_get_a_patch)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.1});
    const PatchLocator locator(mesh);
    const SurfaceId surface(std::size_t{0});
    for (int k = 0; k <= 100; ++k) {
        const float t = static_cast<float>(k) / 100;
        for (const auto& [x, y] : {std::pair{t, -1e-7F}, {t, 1 + 1e-7F}, {-1e-7F, t}, {1 + 1e-7F, t}}) {
            const PatchId patch = locator.locate(surface, x, y);
            ASSERT_TRUE(patch.valid());
            // 1e-7 is a hundred-thousandth of the height of the smallest patch there can be, with an angle of 20°.
            EXPECT_GE(inside(mesh, patch, Vec2(x, y)), -1e-5);
        }
    }
}

TEST(PatchLocator, hits_of_nothing_have_no_patch)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.1});
    Hits hits = random_hits(mesh, 300, 3);
    for (std::size_t i = 0; i < 300; i += 3) hits.surface[i] = i % 2 == 0 ? 1 : 0xffffffffU;
    std::vector<PatchId> found(300, PatchId(std::size_t{0}));
    PatchLocator(mesh).locate(hits.surface, hits.x, hits.y, 1, found);
    for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(found[i].valid(), i % 3 != 0) << i;
}

TEST(PatchLocator, a_surface_without_patches_has_none)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh(scene, {});
    EXPECT_FALSE(PatchLocator(mesh).locate(SurfaceId(std::size_t{0}), 0.5F, 0.5F).valid());
}

TEST(PatchLocator, barycentric_coordinates_give_the_point_back)
{
    const Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.2});
    const PatchLocator locator(mesh);
    const Hits hits = random_hits(mesh, 500, 11);
    for (std::size_t i = 0; i < 500; ++i) {
        const PatchId patch = locator.locate(SurfaceId(std::size_t{0}), hits.x[i], hits.y[i]);
        const auto w = locator.barycentric(patch, hits.at(i));
        const auto c = mesh.corners(patch);
        EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-15);
        EXPECT_GE(std::min({w[0], w[1], w[2]}), 0);
        const Vec2 back =
            w[0] * mesh.plane_position(c[0]) + w[1] * mesh.plane_position(c[1]) + w[2] * mesh.plane_position(c[2]);
        // Clamping moves a point no further than rounding to float did.
        EXPECT_NEAR(glm::distance(back, hits.at(i)), 0, 1e-6);
    }
    const auto far = locator.barycentric(PatchId(std::size_t{0}), {50, -30});
    EXPECT_NEAR(far[0] + far[1] + far[2], 1, 1e-15);
    EXPECT_GE(std::min({far[0], far[1], far[2]}), 0);
}
