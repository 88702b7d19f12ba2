#include "formfactor/lambert.h"

#include "formfactor/random_numbers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace patchlight {
namespace {

// reference-values.md §1: dA below the centre and below the corner of a unit square at h = 1.
TEST(Lambert, SmallAreaBelowAUnitSquare)
{
    const std::array<Vec3, 4> ceiling{Vec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    EXPECT_NEAR(lambert_factor({0.5, 0.5, 0}, {0, 0, 1}, ceiling), 0.23945647046077353883, 1e-14);
    EXPECT_NEAR(lambert_factor({0, 0, 0}, {0, 0, 1}, ceiling), 0.13853160599489299678, 1e-14);
}

// §1: dA on the floor at distance x from a wall of height 1, wide enough to count as endless (the ends subtend
// less than (x/width)² of the factor).
TEST(Lambert, FloorBesideAnEndlessWall)
{
    const double w = 1e6;
    const std::array<Vec3, 4> wall{Vec3{0, -w, 0}, {0, w, 0}, {0, w, 1}, {0, -w, 1}};
    for (const double x : {0.001, 0.01, 0.1, 0.5, 1.0})
        EXPECT_NEAR(lambert_factor({x, 0, 0}, {0, 0, 1}, wall), 0.5 * (1 - x / std::hypot(x, 1.0)), 1e-11) << x;
}

TEST(Lambert, BehindOrInThePlaneOfThePolygonSeesNothing)
{
    const std::array<Vec3, 4> ceiling{Vec3{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    EXPECT_EQ(lambert_factor({0.5, 0.5, 2}, {0, 0, -1}, ceiling), 0);
    EXPECT_EQ(lambert_factor({3, 3, 1}, {1, 0, 0}, ceiling), 0);
    EXPECT_EQ(lambert_factor({0.5, 0.5, 0}, {0, 0, -1}, ceiling), 0) << "below the horizon";
}

// A polygon cut by the horizon must give what its upper part gives.
TEST(Lambert, ClipsAtTheHorizon)
{
    const Vec3 p(0.0), n(0, 0, 1);
    const std::array<Vec3, 4> whole{Vec3{1, -1, -2}, {1, -1, 3}, {1, 1, 3}, {1, 1, -2}};
    const std::array<Vec3, 4> upper{Vec3{1, -1, 0}, {1, -1, 3}, {1, 1, 3}, {1, 1, 0}};
    EXPECT_GT(lambert_factor(p, n, upper), 0.1);
    EXPECT_NEAR(lambert_factor(p, n, whole), lambert_factor(p, n, upper), 1e-15);
}

// Factors are additive, at most 1, and unchanged by position, rotation and scale.
TEST(Lambert, RandomTrianglesAddUpAndDoNotDependOnTheFrame)
{
    RandomNumbers random(7, 0);
    const auto point = [&] { return Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5); };
    for (int trial = 0; trial < 2000; ++trial) {
        const Vec3 p = point(), n = glm::normalize(point()), a = point(), b = point(), c = point();
        const Vec3 m = a + 0.3 * (b - a);
        const std::array<Vec3, 3> whole{a, b, c}, left{a, m, c}, right{m, b, c};
        const double F = lambert_factor(p, n, whole);
        EXPECT_GE(F, 0);
        EXPECT_LE(F, 1);
        // Additive to rounding; the cut's plane test may differ in the last bit, hence the small slack.
        EXPECT_NEAR(F, lambert_factor(p, n, left) + lambert_factor(p, n, right), 1e-12);
        const double s = std::pow(10.0, 6 * random.uniform() - 3);
        const auto moved = [&](const Vec3& x) { return s * Vec3(x.y, x.z, x.x); };
        const std::array<Vec3, 3> turned{moved(a), moved(b), moved(c)};
        EXPECT_NEAR(F, lambert_factor(moved(p), glm::normalize(moved(n)), turned), 1e-12);
    }
}

}  // namespace
}  // namespace patchlight
