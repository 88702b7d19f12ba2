#include "formfactor/point_factor.h"

#include "meshing/read_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace patchlight {
namespace {

struct Known {
    const char* name;
    Vec3 place, normal;  ///< mm
    double blocked;
};

// reference-values.md §3: the light of the Cornell box with both blocks in the way.
const std::vector<Known> known{{"floor", {278, 0, 279.5}, {0, 1, 0}, 0.010484630958},
                               {"floor beside the short block", {70, 0, 250}, {0, 1, 0}, 0.010795472206},
                               {"floor in front", {400, 0, 150}, {0, 1, 0}, 0.011694970340},
                               {"floor in the umbra", {500, 0, 420}, {0, 1, 0}, 0},
                               {"short block's top", {185, 165, 170}, {0, 1, 0}, 0.022291341194},
                               {"wall x = 0", {0, 200, 200}, {1, 0, 0}, 0.009822520488},
                               {"back wall", {278, 200, 559.2}, {0, 0, -1}, 0.010396475081},
                               {"back wall in the umbra", {400, 50, 559.2}, {0, 0, -1}, 0}};

// The issue asks for 1e-9; the table has twelve decimals.
TEST(PointFactor, TheCornellBoxLightWithBothBlocks)
{
    SceneOptions options;
    options.unit = 0.001;
    const Scene scene = read_scene(std::string(PATCHLIGHT_DATA) + "/scenes/cornell-box.obj", options).scene;
    const auto light = std::ranges::find(scene.objects, "light");
    ASSERT_NE(light, scene.objects.end());
    const std::vector<Facet> to = facets_of(scene, ObjectId(static_cast<std::size_t>(light - scene.objects.begin())));
    ASSERT_EQ(to.size(), 1U);
    const Blockers blockers(scene);
    PointScratch scratch;
    for (const Known& k : known)
        EXPECT_NEAR(point_factor(blockers, 0.001 * k.place - scene.center, k.normal, to, scratch), k.blocked, 1e-12)
            << k.name;
}

// Nusselt's analogy: a polygon, its central projection on the half cube (here wholly on the top, or on the side +x) and
// on the unit sphere, whose great circles the formula goes along as well, have one factor.
TEST(PointFactor, APolygonAndItsCentralProjectionsAreOne)
{
    const auto factor = [](const std::vector<Vec3>& corners) {
        VisibleScratch scratch;
        return visible_factor({0, 0, 0}, {0, 0, 1}, corners, {}, scratch);
    };
    for (const auto& [origin, u, v] : {std::tuple(Vec3(.1, .2, 1.4), Vec3(.5, .1, .3), Vec3(-.1, .6, .2)),
                                       std::tuple(Vec3(1.5, .1, .6), Vec3(.1, .6, .2), Vec3(-.3, .1, .3))}) {
        const std::vector<Vec3> polygon{origin, origin + v, origin + .8 * u + v, origin + u};
        std::vector<Vec3> cube, sphere;
        for (const Vec3& p : polygon) {
            cube.push_back(p / std::max(p.x, p.z));
            sphere.push_back(glm::normalize(p));
        }
        const double itself = std::max(factor(polygon), factor({polygon.rbegin(), polygon.rend()}));
        EXPECT_GT(itself, 0.01);
        EXPECT_NEAR(std::max(factor(cube), factor({cube.rbegin(), cube.rend()})), itself, 1e-14);
        EXPECT_NEAR(std::max(factor(sphere), factor({sphere.rbegin(), sphere.rend()})), itself, 1e-14);
    }
}

// A blocker's shadow on the target, cut out by hand: the square [0, 1]² at height 2 behind [0, .25] × [0, 1] at height
// 1, seen from the origin's place below the corner, leaves [.5, 1] × [0, 1].
TEST(PointFactor, WhatIsLeftIsLambertsFactorOfTheRest)
{
    const std::vector<Vec3> square{{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}},
        rest{{.5, 0, 2}, {.5, 1, 2}, {1, 1, 2}, {1, 0, 2}}, near{{0, 0, 1}, {.25, 0, 1}, {.25, 1, 1}, {0, 1, 1}};
    VisibleScratch scratch;
    const BlockerView blocker{near, {0, 0, 1}, 1};
    const std::vector<BlockerView> blockers{blocker};
    const double left = visible_factor({0, 0, 0}, {0, 0, 1}, square, blockers, scratch);
    EXPECT_TRUE(scratch.cut);
    EXPECT_NEAR(left, visible_factor({0, 0, 0}, {0, 0, 1}, rest, {}, scratch), 1e-15);
    EXPECT_FALSE(scratch.cut);
    // Winding and side of a blocker don't matter.
    const std::vector<Vec3> turned{near.rbegin(), near.rend()};
    const std::vector<BlockerView> other{{turned, {0, 0, -1}, -1}};
    EXPECT_NEAR(visible_factor({0, 0, 0}, {0, 0, 1}, square, other, scratch), left, 1e-15);
}

}  // namespace
}  // namespace patchlight
