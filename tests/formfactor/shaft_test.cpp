#include "formfactor/shaft.h"

#include "formfactor/blockers.h"
#include "formfactor/random_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace patchlight {
namespace {

using Corners = std::vector<Vec3>;

Corners square(double x0, double x1, double y0, double y1, double z)
{
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

BlockerView view(const Corners& corners)
{
    const Vec3 n = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    return {corners, n, glm::dot(n, corners[0])};
}

constexpr double snap = 1e-8;

Visibility past(const Corners& blocker)
{
    static const Corners below = square(0, 1, 0, 1, 0), above = square(0, 1, 0, 1, 1);
    return visibility_past({below, above}, view(blocker), snap);
}

TEST(Shaft, ABlockerInTheMiddleHidesInPart)
{
    EXPECT_EQ(past(square(.4, .6, .4, .6, .5)), Visibility::partial);
    EXPECT_EQ(past(square(.9, 2, .9, 2, .5)), Visibility::partial) << "a corner reaches in";
    EXPECT_EQ(past({{-1, .5, .5}, {2, .5, .5}, {.5, .5, .6}}), Visibility::partial) << "upright, right through";
}

TEST(Shaft, ABlockerBesideItHidesNothing)
{
    EXPECT_EQ(past(square(1.1, 2, 0, 1, .5)), Visibility::visible);
    EXPECT_EQ(past(square(0, 1, 0, 1, 1.5)), Visibility::visible);
    EXPECT_EQ(past({{1.5, -3, .5}, {1.5, 3, -3}, {1.5, 3, 3}}), Visibility::visible);
    EXPECT_EQ(past({{1.5, .4, .5}, {.4, 1.5, .5}, {1.6, 1.6, .5}}), Visibility::partial) << "it cuts the corner off";
    EXPECT_EQ(past({{2.1, 0, .5}, {0, 2.1, .5}, {2.1, 2.1, .5}}), Visibility::visible) << "past the corner, aslant";
}

// Walls of a room touch the shafts of its floor everywhere; what only touches hides nothing.
TEST(Shaft, TouchingIsNotHiding)
{
    EXPECT_EQ(past(square(1, 2, 0, 1, .5)), Visibility::visible) << "edge on the side plane";
    EXPECT_EQ(past({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}), Visibility::visible) << "the wall between both";
    EXPECT_EQ(past(square(0, 1, 0, 1, 1)), Visibility::visible) << "in the plane of one end";
    EXPECT_EQ(past({{1, 1, .5}, {2, 1, .5}, {2, 2, .5}}), Visibility::visible) << "a corner on the shaft's edge";
}

TEST(Shaft, ABlockerAcrossAllHidesAll)
{
    EXPECT_EQ(past(square(0, 1, 0, 1, .5)), Visibility::hidden) << "just as wide";
    EXPECT_EQ(past(square(-1, 2, -1, 2, .5)), Visibility::hidden);
    EXPECT_EQ(past({{-9, -9, .2}, {9, -9, .8}, {0, 20, .5}}), Visibility::hidden) << "aslant";
    EXPECT_EQ(past(square(0, .999, 0, 1, .5)), Visibility::partial);
}

/// Whether a segment crosses the inside of a convex polygon.
bool crosses(const Vec3& x, const Vec3& y, const Corners& polygon)
{
    const BlockerView b = view(polygon);
    const double hx = glm::dot(b.normal, x) - b.offset, hy = glm::dot(b.normal, y) - b.offset;
    if (hx * hy >= 0) return false;
    const Vec3 p = x + hx / (hx - hy) * (y - x);
    for (std::size_t k = 0; k < polygon.size(); ++k)
        if (glm::dot(glm::cross(polygon[(k + 1) % polygon.size()] - polygon[k], p - polygon[k]), b.normal) < 0)
            return false;
    return true;
}

// What it says must hold for every segment: visible or hidden is never wrong, over random triangles of all sizes.
TEST(Shaft, IsNeverWrongAboutRandomTriangles)
{
    int visible = 0, hidden = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        RandomNumbers random(3, i);
        const auto any = [&](double size) {
            return size * (Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
        };
        const auto triangle = [&](double size, const Vec3& at) {
            return Corners{at + any(size), at + any(size), at + any(size)};
        };
        const Corners a = triangle(1, {0, 0, 0}), b = triangle(1, {0, 0, 2});
        const Corners c = triangle(0.3 + 8 * random.uniform() * random.uniform(), Vec3(0, 0, 1) + any(2));
        const Visibility v = visibility_past({a, b}, view(c), snap);
        if (v == Visibility::partial) continue;
        (v == Visibility::visible ? visible : hidden) += 1;
        for (int k = 0; k < 60; ++k) {
            const auto on = [&](const Corners& t) {
                const double u = random.uniform(), w = random.uniform() * (1 - u);
                return t[0] + u * (t[1] - t[0]) + w * (t[2] - t[0]);
            };
            ASSERT_EQ(crosses(on(a), on(b), c), v == Visibility::hidden) << i;
        }
    }
    EXPECT_GT(visible, 3000);
    EXPECT_GT(hidden, 100);
}

// The box tree leaves none out: all that crosses a segment between both ends is in the list.
TEST(Blockers, NoneIsMissed)
{
    std::vector<Blocker> all;
    RandomNumbers random(8, 8);
    const auto any = [&](double size) {
        return size * (Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
    };
    for (int k = 0; k < 400; ++k) {
        const Vec3 at = any(4);
        Blocker blocker;
        blocker.corners.assign({at + any(.6), at + any(.6), at + any(.6)});
        blocker.normal = glm::normalize(
            glm::cross(blocker.corners[1] - blocker.corners[0], blocker.corners[2] - blocker.corners[0]));
        blocker.offset = glm::dot(blocker.normal, blocker.corners[0]);
        all.push_back(blocker);
    }
    const Blockers blockers(all, 4);
    const Corners a = square(-1, 1, -1, 1, -2), b = square(-1, 1, -1, 1, 2);
    std::vector<Blocker> found;
    EXPECT_EQ(blockers.between(a, {0, 0, 1}, b, {0, 0, -1}, found), Visibility::partial);
    std::size_t crossed = 0;
    for (const Blocker& blocker : all) {
        const Corners corners(blocker.corners.begin(), blocker.corners.end());
        bool any_ray = false;
        for (int k = 0; k < 300 && !any_ray; ++k)
            any_ray = crosses({2 * random.uniform() - 1, 2 * random.uniform() - 1, -2},
                              {2 * random.uniform() - 1, 2 * random.uniform() - 1, 2}, corners);
        if (!any_ray) continue;
        ++crossed;
        EXPECT_TRUE(std::ranges::any_of(found, [&](const Blocker& f) { return f.normal == blocker.normal; }));
    }
    EXPECT_GT(crossed, 50U);
}

}  // namespace
}  // namespace patchlight
