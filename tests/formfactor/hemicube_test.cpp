#include "formfactor/hemicube.h"

#include "formfactor/lambert.h"
#include "formfactor/random_numbers.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace patchlight {
namespace {

using Triangles = std::vector<HemicubeTriangle>;

void add_polygon(Triangles& triangles, const std::vector<Vec3>& corners, std::uint32_t item)
{
    for (std::size_t k = 2; k < corners.size(); ++k)
        triangles.push_back({{corners[0], corners[k - 1], corners[k]}, item});
}

/// ΣΔF − 1 in units of 1/resolution², see AllPixelsSumToOneWithSecondOrder.
const double midpoint_error = 0.54196319191119;

/// Three standard errors of a factor: the pixels on an outline of 4·resolution pixels each err by a random part of
/// up to half their ΔF, which is 4/(π·resolution²) at most.
double outline_error(int resolution)
{
    return 3 * 4 / (std::numbers::pi * resolution * resolution) * std::sqrt(4 * resolution / 12.0);
}

/// A frame that no scene below is aligned with.
PlaneFrame tilted_frame(const Vec3& origin)
{
    const Vec3 n = glm::normalize(Vec3(0.2, -0.31, 0.9)), u = glm::normalize(glm::cross(Vec3(0.3, 1, 0.1), n));
    return {origin, u, glm::cross(n, u), n};
}

HemicubeSums sums_of(Hemicube& cube, const Triangles& triangles, const PlaneFrame& frame, double turn = 0)
{
    HemicubeSums sums;
    cube.render(triangles, frame, turn);
    cube.sum(sums);
    return sums;
}

double factor_of(const HemicubeSums& sums, std::uint32_t item)
{
    for (std::size_t k = 0; k < sums.items.size(); ++k)
        if (sums.items[k] == item) return sums.factors[k];
    return 0;
}

std::vector<std::uint32_t> items_of(const Hemicube& cube)
{
    std::vector<std::uint32_t> items;
    for (std::size_t q = 0; q < cube.pixels(); ++q) items.push_back(cube.item(q));
    return items;
}

/// The root mean square error of item 0 over turns: one render's own is as jumpy as the outline's pixels.
double error_of(int resolution, const Triangles& triangles, const PlaneFrame& frame, double expected)
{
    Hemicube cube(resolution);
    double squares = 0;
    const int turns = 40;
    for (int k = 0; k < turns; ++k) {
        const double e = factor_of(sums_of(cube, triangles, frame, 0.1 + 0.161 * k), 0) - expected;
        squares += e * e;
    }
    return std::sqrt(squares / turns);
}

/// Items are surfaces.
Triangles triangles_of(const Scene& scene)
{
    Triangles triangles;
    for (const SceneTriangle& t : scene.triangles)
        triangles.push_back(
            {{scene.vertices[t.vertices[0]], scene.vertices[t.vertices[1]], scene.vertices[t.vertices[2]]},
             t.front.value});
    return triangles;
}

Triangles cube_triangles()
{
    return triangles_of(testing::cube_inside({0, 0, 0, 0, 0, 0}, {Material{}}));
}

TEST(Hemicube, RefusesResolutionsThatHaveNoHalf)
{
    for (const int resolution : {-2, 0, 2, 7, 129, 4098}) EXPECT_THROW(Hemicube{resolution}, std::invalid_argument);
    EXPECT_EQ(Hemicube(4).pixels(), 48U);
}

TEST(Hemicube, RefusesWhatIsNotFiniteAndItemsBeyondTheLast)
{
    Hemicube cube(16);
    Triangles triangles{{{Vec3{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}, Hemicube::max_item + 1}};
    EXPECT_THROW(cube.render(triangles, {}), std::invalid_argument);
    triangles[0] = {{Vec3{0, 0, 1}, {0, 1, std::numeric_limits<double>::quiet_NaN()}, {1, 0, 1}}, 0};
    EXPECT_THROW(cube.render(triangles, {}), std::invalid_argument);
    triangles[0].corners[1].z = std::numeric_limits<double>::infinity();
    EXPECT_THROW(cube.render(triangles, {}), std::invalid_argument);
}

// The midpoint rule over smooth ΔF: Σ ΔF − 1 is second order, −h²/24 ∮ ∂f/∂n along the edges of the five faces,
// which comes to 0.54196/resolution² (h = 2/resolution); the next order is 1/resolution² smaller.
TEST(Hemicube, AllPixelsSumToOneWithSecondOrder)
{
    for (const int resolution : {16, 32, 64, 128, 256}) {
        Hemicube cube(resolution);
        double sum = 0;
        for (std::size_t q = 0; q < cube.pixels(); ++q) sum += cube.factor(q);
        EXPECT_NEAR(sum - 1, midpoint_error / (resolution * resolution), 2 * std::pow(resolution, -4.0)) << resolution;
        const HemicubeSums empty = sums_of(cube, {}, {});
        EXPECT_NEAR(empty.escaped, sum, 1e-13);
        EXPECT_TRUE(empty.items.empty());
    }
}

// Only the pixels on the outline err, each by up to half its ΔF and as good as at random: R of them of 1/R² each,
// an error of R^-1.5 (edges along the pixels' rows err together, R^-1, but few turns bring that about). From 32 to
// 512 that is 64 times; 20 leaves room for chance over 40 turns.
TEST(Hemicube, SquareLightConvergesToLambert)
{
    const std::vector<Vec3> light{{-0.3, -0.4, 1}, {-0.3, 0.6, 1}, {0.7, 0.6, 1}, {0.7, -0.4, 1}};
    Triangles triangles;
    add_polygon(triangles, light, 0);
    const double expected = lambert_factor(Vec3(0.0), {0, 0, 1}, light);
    const double coarse = error_of(32, triangles, {}, expected), fine = error_of(512, triangles, {}, expected);
    EXPECT_LT(fine, coarse / 20);
    EXPECT_LT(coarse, 0.02 * expected);
    EXPECT_LT(fine, 5e-4 * expected);
}

TEST(Hemicube, CubesWallsFromTheFloorAreLamberts)
{
    const Triangles triangles = cube_triangles();
    Hemicube cube(256);
    for (const Vec3& p : {Vec3(0, 0, -1), Vec3(0.31, -0.72, -1), Vec3(-0.95, 0.97, -1)}) {
        const HemicubeSums sums = sums_of(cube, triangles, {.origin = p}, 0.3);
        // Nothing is lost: what is missing is the rule's own 1/resolution².
        EXPECT_EQ(sums.escaped, 0);
        EXPECT_EQ(sums.backs, 0);
        EXPECT_NEAR(sums.total() - 1, midpoint_error / (256 * 256), 1e-9);
        EXPECT_EQ(factor_of(sums, 0), 0) << "the floor doesn't see itself";
        for (std::uint32_t wall = 1; wall < 6; ++wall) {
            double expected = 0;
            for (const HemicubeTriangle& t : triangles)
                if (t.item == wall) expected += lambert_factor(p, {0, 0, 1}, t.corners);
            EXPECT_NEAR(factor_of(sums, wall), expected, outline_error(256)) << wall;
        }
    }
}

// Turned off the axes, the floor's plane passes the origin by rounding only: the floor must stay unseen all the same.
TEST(Hemicube, OwnPlaneStaysUnseenInAnyAttitude)
{
    RandomNumbers random(5, 0);
    Hemicube cube(64);
    for (int trial = 0; trial < 50; ++trial) {
        const auto axis = [&] { return Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5); };
        const Vec3 n = glm::normalize(axis()), u = glm::normalize(glm::cross(axis(), n)), v = glm::cross(n, u);
        const auto placed = [&](const Vec3& p) { return Vec3(3, -7, 11) + p.x * u + p.y * v + p.z * n; };
        Triangles triangles = cube_triangles();
        for (HemicubeTriangle& t : triangles)
            for (Vec3& corner : t.corners) corner = placed(corner);
        const Vec3 origin = placed({2 * random.uniform() - 1, 2 * random.uniform() - 1, -1});
        const HemicubeSums sums = sums_of(cube, triangles, {origin, u, v, n}, 6 * random.uniform());
        EXPECT_EQ(factor_of(sums, 0), 0);
        EXPECT_EQ(sums.escaped, 0);
        EXPECT_EQ(sums.backs, 0);
    }
}

TEST(Hemicube, TrianglesAcrossThreeFacesAreClippedAtTheirEdges)
{
    // Around the corner direction (1, 1, 1), below the horizon and behind the origin on its far ends.
    const std::vector<std::vector<Vec3>> shapes{{{2, 0.3, 0.4}, {0.4, 0.2, 2.2}, {0.3, 2, 0.5}},
                                                {{5, -1, -2}, {-2, -2, 9}, {-1, 6, -1}},
                                                {{40, 30, -30}, {-30, -20, 40}, {-31, 42, -20}}};
    Hemicube cube(512);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
        Triangles triangles{{{shapes[k][0], shapes[k][1], shapes[k][2]}, 0}};
        const double expected = lambert_factor(Vec3(0.0), {0, 0, 1}, shapes[k]);
        ASSERT_GT(expected, 0.1);
        const HemicubeSums sums = sums_of(cube, triangles, {});
        EXPECT_NEAR(factor_of(sums, 0), expected, outline_error(512)) << k;
        const std::vector<std::uint32_t> seen = items_of(cube);
        std::set<std::size_t> faces;  // the top is the first two of six blocks
        for (std::size_t q = 0; q < seen.size(); ++q)
            if (seen[q] == 0) faces.insert(std::max<std::size_t>(6 * q / seen.size(), 1));
        EXPECT_GE(faces.size(), 3U) << k;
    }
}

// Additive pixel by pixel: a fan around an inner point covers what the whole covers, no pixel left, none more.
TEST(Hemicube, NeighboursLeaveNoCracks)
{
    RandomNumbers random(3, 0);
    const auto point = [&](double z) { return Vec3(4 * random.uniform() - 2, 4 * random.uniform() - 2, z); };
    Hemicube cube(64);
    for (int trial = 0; trial < 300; ++trial) {
        const Vec3 a = point(2 * random.uniform() - 1), b = point(1), c = point(0.3 + random.uniform());
        const Vec3 m = (0.5 * a + 0.3 * b) + 0.2 * c;
        const Triangles whole{{{a, b, c}, 0}};
        const Triangles fan{{{a, b, m}, 0}, {{b, c, m}, 0}, {{c, a, m}, 0}};
        cube.render(whole, {});
        const auto expected = items_of(cube);
        cube.render(fan, {});
        EXPECT_EQ(items_of(cube), expected) << trial;
    }
}

// The hard case: a common edge that runs through pixels' centres, from inside the top to beyond it.
TEST(Hemicube, DiagonalsThroughPixelCentresLeaveNoCracks)
{
    RandomNumbers random(4, 0);
    Hemicube cube(64);
    for (int trial = 0; trial < 300; ++trial) {
        const double low = -1.5 * random.uniform(), high = 1.5 * random.uniform(), z = 0.3 + random.uniform();
        const Vec3 a(3 * low, low, z), c(3 * high, high, z), aside = random.uniform() * Vec3(-1, 3, 0);
        const Vec3 b = 0.5 * (a + c) + aside, d = 0.5 * (a + c) - aside;
        cube.render(Triangles{{{a, b, d}, 0}, {{b, c, d}, 0}}, {});
        const auto expected = items_of(cube);
        cube.render(Triangles{{{a, b, c}, 0}, {{c, d, a}, 0}}, {});
        EXPECT_EQ(items_of(cube), expected) << trial;
    }
}

/// A room with a floating slab, a pillar of four walls (backs inside) and a single sheet that shows its back.
Scene blocked_room()
{
    Scene scene = testing::cube_inside({0, 0, 0, 0, 0, 0}, {Material{}});
    testing::add_surface(scene, {{-0.5, -0.6, 0.2}, {-0.6, 0.4, 0.3}, {0.3, 0.5, 0.25}}, 0);
    testing::add_surface(scene, {{0.4, 0.4, -0.9}, {0.4, 0.7, -0.9}, {0.4, 0.7, 0.8}, {0.4, 0.4, 0.8}}, 0);
    testing::add_surface(scene, {{0.4, 0.4, -0.9}, {0.4, 0.4, 0.8}, {0.7, 0.4, 0.8}, {0.7, 0.4, -0.9}}, 0);
    testing::add_surface(scene, {{-0.8, 0.1, -0.7}, {-0.2, 0.6, -0.6}, {-0.4, 0.7, 0.1}}, 0);
    testing::add_surface(scene, {{0.1, -0.8, -0.7}, {0.6, -0.5, -0.6}, {0.3, -0.7, 0.4}}, 0);
    return scene;
}

/// Whether another pixel around q sees something else; at a face's border the neighbours beyond it aren't asked.
bool on_an_outline(const std::vector<std::uint32_t>& seen, std::size_t q, std::size_t resolution)
{
    const auto r = static_cast<std::ptrdiff_t>(resolution), row = static_cast<std::ptrdiff_t>(q) / r;
    const auto column = static_cast<std::ptrdiff_t>(q) % r, rows = static_cast<std::ptrdiff_t>(seen.size()) / r;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(row - 1, 0); j <= std::min(row + 1, rows - 1); ++j)
        for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(column - 1, 0); i <= std::min(column + 1, r - 1); ++i)
            if (seen[static_cast<std::size_t>(j * r + i)] != seen[q]) return true;
    return false;
}

TEST(Hemicube, PixelsSeeWhatRaysThroughTheirCentresHit)
{
    const Scene scene = blocked_room();
    const Triangles triangles = triangles_of(scene);
    const RayCaster caster(scene);
    Hemicube cube(128);
    RayBatch rays;
    HitBatch hits;
    for (const Vec3& origin : {Vec3(0.05, -0.1, -0.55), Vec3(0.13, 0.02, -0.1), Vec3(-0.7, -0.8, -0.9)}) {
        cube.render(triangles, tilted_frame(origin), 0.7);
        rays.resize(cube.pixels());
        for (std::size_t q = 0; q < cube.pixels(); ++q) rays.set(q, origin, cube.direction(q), 1e9F);
        caster.closest(rays, hits);
        const std::vector<std::uint32_t> seen = items_of(cube);
        std::size_t different = 0;
        std::map<std::uint32_t, int> kinds;
        for (std::size_t q = 0; q < cube.pixels(); ++q) {
            ++kinds[seen[q]];
            if (seen[q] == hits.surface[q]) continue;
            ++different;
            EXPECT_TRUE(on_an_outline(seen, q, 128)) << q << ": " << seen[q] << " against " << hits.surface[q];
        }
        EXPECT_GE(kinds.size(), 6U);
        EXPECT_GT(kinds[Hemicube::black_back], 50);
        EXPECT_LT(different, cube.pixels() / 100);
    }
}

TEST(Hemicube, ATurnChangesTheFactorsByTheOutlinesOnly)
{
    const Scene scene = blocked_room();
    const Triangles triangles = triangles_of(scene);
    Hemicube cube(256);
    const PlaneFrame frame = tilted_frame({0.05, -0.1, -0.55});
    const HemicubeSums straight = sums_of(cube, triangles, frame);
    for (const double turn : {0.2, 1.1, 4.0}) {
        const HemicubeSums turned = sums_of(cube, triangles, frame, turn);
        EXPECT_EQ(turned.items.size(), straight.items.size());
        // Two renders, each with its error.
        for (std::size_t k = 0; k < straight.items.size(); ++k)
            EXPECT_NEAR(factor_of(turned, straight.items[k]), straight.factors[k],
                        std::numbers::sqrt2 * outline_error(256));
        EXPECT_NEAR(turned.backs, straight.backs, std::numbers::sqrt2 * outline_error(256));
    }
    // A quarter turn moves the sides onto each other: the same pixels up to rounding at their centres.
    const HemicubeSums quarter = sums_of(cube, triangles, frame, std::numbers::pi / 2);
    for (std::size_t k = 0; k < straight.items.size(); ++k)
        EXPECT_NEAR(factor_of(quarter, straight.items[k]), straight.factors[k], 2.0 / (256 * 256));
}

TEST(Hemicube, BacksBlockAndAreBlack)
{
    Triangles triangles;
    add_polygon(triangles, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, 0);
    Hemicube cube(128);
    const double whole = factor_of(sums_of(cube, triangles, {}), 0);
    // Half of the light is behind a sheet that turns its back to the origin.
    add_polygon(triangles, {{0, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {0, 0.5, 1}}, 1);
    const HemicubeSums sums = sums_of(cube, triangles, {});
    EXPECT_EQ(factor_of(sums, 1), 0);
    EXPECT_NEAR(factor_of(sums, 0), whole / 2, 1e-12);
    EXPECT_NEAR(sums.backs, whole / 2, 1e-12);
}

TEST(Hemicube, TheSideThatFacesTheOriginWinsWhereTwoLieInOnePlane)
{
    // Coplanar, cut along different diagonals, tilted so that no depth is a round number.
    const Vec3 a(-1, -1.1, 1.3), u(2.1, 0.2, 0.31), v(-0.1, 1.9, -0.27);
    const std::vector<Vec3> front{a, a + v, a + u + v, a + u}, back{a + u, a + u + v, a + v, a};
    Triangles both;
    add_polygon(both, back, 0);
    add_polygon(both, front, 5);
    Hemicube cube(128);
    for (int order = 0; order < 2; ++order) {
        const HemicubeSums sums = sums_of(cube, both, tilted_frame(Vec3(0.0)));
        ASSERT_EQ(sums.items, std::vector<std::uint32_t>{5});
        EXPECT_EQ(sums.backs, 0);
        std::reverse(both.begin(), both.end());
    }
    // Coordinates that were rounded to single precision on the way, the back's towards the origin.
    for (HemicubeTriangle& t : both)
        if (t.item == 0)
            for (Vec3& corner : t.corners) corner *= 1 - 1e-7;
    EXPECT_EQ(sums_of(cube, both, tilted_frame(Vec3(0.0))).items, std::vector<std::uint32_t>{5});
    EXPECT_EQ(sums_of(cube, both, tilted_frame(Vec3(0.0))).backs, 0);
}

TEST(Hemicube, TheLowerItemWinsATie)
{
    Triangles triangles;
    for (const std::uint32_t item : {3U, 1U, 2U})
        add_polygon(triangles, {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, item);
    Hemicube cube(64);
    EXPECT_EQ(sums_of(cube, triangles, {}).items, std::vector<std::uint32_t>{1});
}

TEST(Hemicube, TheOrderOfTrianglesDoesNotMatter)
{
    RandomNumbers random(11, 0);
    const auto point = [&] { return Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5); };
    Triangles triangles;
    for (std::uint32_t k = 0; k < 300; ++k) {
        const Vec3 center = 4.0 * point();
        triangles.push_back({{center + point(), center + point(), center + point()}, k});
        // Some come twice, as another item.
        if (k % 5 == 0) triangles.push_back({triangles.back().corners, 1000 - k});
    }
    Hemicube cube(128);
    cube.render(triangles, tilted_frame(Vec3(0.0)));
    const auto expected = items_of(cube);
    for (int trial = 0; trial < 5; ++trial) {
        for (std::size_t i = triangles.size(); i > 1; --i)
            std::swap(triangles[i - 1], triangles[random.below(static_cast<std::uint32_t>(i))]);
        cube.render(triangles, tilted_frame(Vec3(0.0)));
        EXPECT_EQ(items_of(cube), expected);
    }
}

// Powers of two scale exactly: the same pixels. Item ids and buffers of earlier renders leave nothing behind.
TEST(Hemicube, ScaleAndEarlierRendersChangeNothing)
{
    Triangles triangles = cube_triangles();
    Hemicube cube(64);
    const HemicubeSums expected = sums_of(cube, triangles, {.origin = Vec3(0.25, 0.5, -1)});
    for (const double scale : {0x1p-10, 0x1p10}) {
        Triangles scaled = triangles;
        for (HemicubeTriangle& t : scaled)
            for (Vec3& corner : t.corners) corner *= scale;
        const HemicubeSums sums = sums_of(cube, scaled, {.origin = scale * Vec3(0.25, 0.5, -1)});
        EXPECT_EQ(sums.items, expected.items);
        EXPECT_EQ(sums.factors, expected.factors);
    }
}

}  // namespace
}  // namespace patchlight
