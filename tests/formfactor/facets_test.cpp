#include "formfactor/facets.h"

#include "boxes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patchlight {
namespace {

TEST(Facets, AConvexSurfaceIsOne)
{
    const Scene scene = testing::cube_inside({0, 0, 0, 0, 0, 0}, {Material{}});
    const std::vector<Facet> facets = facets_of(scene);
    ASSERT_EQ(facets.size(), 6U);
    for (const Facet& facet : facets) {
        EXPECT_EQ(facet.corners.size(), 4U);
        EXPECT_DOUBLE_EQ(facet.area, 4);
    }
    EXPECT_DOUBLE_EQ(total_area(facets), 24);
}

/// A square frame in z = 0: outer square of side 3, hole of side 1, as eight triangles around.
Scene frame()
{
    Scene scene;
    scene.objects = {"frame"};
    scene.materials.emplace_back();
    scene.diameter = 3 * std::sqrt(2.0);
    scene.vertices = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
    Surface surface;
    surface.material = MaterialId(std::size_t{0});
    surface.object = ObjectId(std::size_t{0});
    surface.area = 8;
    surface.loops = {{0, 1, 2, 3}, {4, 7, 6, 5}};
    scene.surfaces.push_back(surface);
    for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t next = (k + 1) % 4;
        scene.triangles.push_back({{k, next, 4 + next}, SurfaceId(std::size_t{0}), {}});
        scene.triangles.push_back({{k, 4 + next, 4 + k}, SurfaceId(std::size_t{0}), {}});
    }
    return scene;
}

// Eight triangles join to four trapezoids: none of two can be joined further.
TEST(Facets, ASurfaceWithAHoleIsCutIntoFewConvexOnes)
{
    const std::vector<Facet> facets = facets_of(frame());
    EXPECT_LE(facets.size(), 4U);
    EXPECT_NEAR(total_area(facets), 8, 1e-14);
    for (const Facet& facet : facets)
        for (std::size_t k = 0; k < facet.corners.size(); ++k) {
            const Vec3 &a = facet.corners[k], &b = facet.corners[(k + 1) % facet.corners.size()],
                       &c = facet.corners[(k + 2) % facet.corners.size()];
            EXPECT_GT(glm::dot(glm::cross(b - a, c - b), facet.normal), 0) << "convex, no corner straight";
        }
}

TEST(Facets, TheBackOfATriangleRunsTheOtherWay)
{
    Scene scene = frame();
    scene.surfaces[0].frame.n = {0, 0, -1};
    scene.surfaces[0].loops = {{3, 2, 1, 0}, {5, 6, 7, 4}};
    for (SceneTriangle& t : scene.triangles) std::swap(t.front, t.back);
    const std::vector<Facet> facets = facets_of(scene);
    EXPECT_NEAR(total_area(facets), 8, 1e-14);
    for (const Facet& facet : facets)
        EXPECT_LT(glm::cross(facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]).z, 0);
}

}  // namespace
}  // namespace patchlight
