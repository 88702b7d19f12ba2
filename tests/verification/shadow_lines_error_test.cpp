// The cases of reference-values.md §5, solved as scenes as they stand, turned and moved: how large the error is on so
// many triangles, how fast it falls, how many triangles it takes for 1 %, and how many it takes without the lines.
// The light is direct alone, so the rays that look for more can be few.
#include "tests/verification/shadow_case.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace patchlight::verification {
namespace {

struct Placed {
    std::string name;
    Placement placement;
};

const Vec3 far_off(13.7, -2.1, 5.3);
const glm::dmat3 askew(glm::rotate(glm::dmat4(1.0), 0.83, Vec3(1.0, 2.0, -0.7)));

/// One mesh: the receiver's triangles, its error, and what the solver takes that for.
struct Point {
    std::size_t triangles = 0;
    double error = 0, estimate = 0;
};

Point solved(const SolvedShadow& shadow, Refine refine, std::size_t elements)
{
    const AdaptiveSolution solution = shadow.solve(refine, elements);
    return {shadow.count(solution), shadow.error(solution), solution.error.relative};
}

void print(const std::string& what, const Point& point)
{
    std::printf("| %s | %zu | %.2e | %.2e |\n", what.c_str(), point.triangles, point.error, point.estimate);
}

// What a prototype reached on so many triangles; the bounds that were asked for are 1.5 to 4 times as large.
const std::map<std::string, std::vector<Point>> known{
    {"narrow", {{1024, 1.1e-3}, {4096, 3.1e-4}}},
    {"wide", {{256, 7.5e-3}, {4096, 4.5e-4}}},
    {"wall", {{1024, 2.1e-3}, {4096, 5.2e-4}, {16384, 1.3e-4}}},
};

class ShadowLinesError : public ::testing::TestWithParam<std::tuple<const char*, Placed>> {};

TEST_P(ShadowLinesError, OnSoManyTriangles)
{
    const auto& [name, placed] = GetParam();
    const SolvedShadow shadow(shadow_case(name), placed.placement);
    for (const Point& aim : known.at(name)) {
        const Point found = solved(shadow, Refine::both, aim.triangles);
        print(name + (", " + placed.name), found);
        EXPECT_LE(found.triangles, aim.triangles);
        // Meshes of a few triangles more or less, or turned, differ by some percent.
        EXPECT_LE(found.error, 1.1 * aim.error) << found.triangles << " triangles";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, ShadowLinesError,
    ::testing::Combine(::testing::Values("narrow", "wide", "wall"),
                       ::testing::Values(Placed{"AsItStands", {}}, Placed{"Moved", {glm::dmat3(1.0), far_off}},
                                         Placed{"TurnedAndMoved", {askew, far_off}})),
    [](const auto& test) { return std::string(std::get<0>(test.param)) + std::get<1>(test.param).name; });

/// The slope of the straight line nearest to log error over log triangles, turned positive.
double rate(const std::vector<Point>& points)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Point& p : points) {
        const double u = std::log(static_cast<double>(p.triangles)), v = std::log(p.error);
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    return -(n * xy - x * y) / (n * xx - x * x);
}

class ShadowLinesRate : public ::testing::TestWithParam<const char*> {};

TEST_P(ShadowLinesRate, IsThatOfSmoothLight)
{
    const SolvedShadow shadow(shadow_case(GetParam()));
    std::vector<Point> points, quadratic;
    for (const std::size_t n : {1024UL, 2048UL, 4096UL, 8192UL, 16384UL}) {
        const AdaptiveSolution solution = shadow.solve(Refine::both, n, Elements::quadratic);
        points.push_back({shadow.count(solution), shadow.error(solution), solution.error.relative});
        quadratic.push_back({points.back().triangles, shadow.error(solution, Elements::quadratic)});
        print(GetParam(), points.back());
        std::printf("| %s, quadratic | %zu | %.2e | |\n", GetParam(), quadratic.back().triangles,
                    quadratic.back().error);
        // The indicator tracks the error: it is judged against the same light.
        EXPECT_NEAR(points.back().estimate / points.back().error, 1, 0.5) << n;
    }
    std::printf("%s: linear N^-%.2f, quadratic N^-%.2f\n", GetParam(), rate(points), rate(quadratic));
    EXPECT_GE(rate(points), 0.9);
    EXPECT_GE(rate(quadratic), 1.3);
}

INSTANTIATE_TEST_SUITE_P(Cases, ShadowLinesRate, ::testing::Values("narrow", "wide", "wall"),
                         [](const auto& test) { return std::string(test.param); });

/// The triangles that bring the error to 1 %: between the first budget that does and the one before, as if the error
/// fell like a power between them. Budgets grow by √2. Infinite when none does.
double for_one_percent(const SolvedShadow& shadow, Refine refine, double first, double last)
{
    constexpr double goal = 0.01;
    Point before;
    for (double budget = first; budget < last; budget *= std::sqrt(2.0)) {
        const Point now = solved(shadow, refine, static_cast<std::size_t>(budget + 0.5));
        const double there = static_cast<double>(now.triangles), here = static_cast<double>(before.triangles);
        if (now.error <= goal && before.triangles == 0) return there;
        if (now.error <= goal)
            return here * std::pow(there / here, std::log(before.error / goal) / std::log(before.error / now.error));
        before = now;
    }
    return std::numeric_limits<double>::infinity();
}

void print_one_percent(const char* name, double uniform, double intensity, double both)
{
    std::printf("| %s, 1 %% | uniform %.0f | intensity %.0f | both %.0f |\n", name, uniform, intensity, both);
}

// Bounds on the triangles are a fifth above the known 98, 190 and 200.

TEST(OnePercent, NarrowPenumbra)
{
    const SolvedShadow shadow(shadow_case("narrow"));
    const double both = for_one_percent(shadow, Refine::both, 64, 300);
    const double intensity = for_one_percent(shadow, Refine::intensity, 724, 3000);
    const double uniform = for_one_percent(shadow, Refine::none, 28000, 41000);
    print_one_percent("narrow", uniform, intensity, both);
    EXPECT_LE(both, 120);
    EXPECT_NEAR(uniform / 33700, 1, 0.15) << "the known value";
    EXPECT_GE(uniform, 40 * both);
    EXPECT_GE(intensity, 10 * both) << "15 of the reference's adaptive mesh, which needs 1,790";
}

TEST(OnePercent, WidePenumbra)
{
    const SolvedShadow shadow(shadow_case("wide"));
    const double both = for_one_percent(shadow, Refine::both, 64, 520);
    const double intensity = for_one_percent(shadow, Refine::intensity, 128, 1100);
    const double uniform = for_one_percent(shadow, Refine::none, 362, 1500);
    print_one_percent("wide", uniform, intensity, both);
    EXPECT_LE(both, 230);
    EXPECT_NEAR(uniform / 600, 1, 0.15) << "the known value";
    EXPECT_GE(intensity, 1.2 * both);
}

TEST(OnePercent, WallOnTheFloor)
{
    const SolvedShadow shadow(shadow_case("wall"));
    const double both = for_one_percent(shadow, Refine::both, 128, 520);
    const double intensity = for_one_percent(shadow, Refine::intensity, 1024, 6000);
    print_one_percent("wall", std::numeric_limits<double>::infinity(), intensity, both);
    EXPECT_LE(both, 240);
    EXPECT_GE(intensity, 6 * both) << "without the contact line";
}

}  // namespace
}  // namespace patchlight::verification
