#include "solver/discontinuities.h"

#include "formfactor/direct_light.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

const SurfaceId the_floor{std::size_t{0}};
const Rgb exitance{10, 5, 2};
constexpr double rho = 0.5;

/// A floor from x = `from`, and a lamp 1 m above it that faces down.
Scene lit_floor(double from, const Vec2& low, const Vec2& high)
{
    Scene scene;
    scene.objects = {"all"};
    scene.materials = {{.name = "grey", .reflectance = Rgb(rho)},
                       {.name = "lamp", .reflectance = Rgb(0.0), .emission = exitance},
                       {.name = "black", .reflectance = Rgb(0.0)}};
    testing::add_surface(scene, {{from, -2, 0}, {2, -2, 0}, {2, 2, 0}, {from, 2, 0}}, 0);
    testing::add_surface(scene, {{low.x, low.y, 1}, {low.x, high.y, 1}, {high.x, high.y, 1}, {high.x, low.y, 1}}, 1);
    return scene;
}

/// The lamp is 0.2 × 2 m; a blocker wide beyond what it may shade hides, 0.25 m up, all with x > 0.
Scene half_shaded_floor(double from = -2)
{
    Scene scene = lit_floor(from, {-0.1, -1}, {0.1, 1});
    testing::add_surface(scene, {{0, -4, 0.25}, {3, -4, 0.25}, {3, 4, 0.25}, {0, 4, 0.25}}, 2);
    return scene;
}

std::vector<Discontinuity> measured(const Scene& scene, const std::vector<Vec2>& ends)
{
    const std::vector<SurfaceId> sources{SurfaceId(std::size_t{1})};
    const DirectLight direct(scene, sources);
    std::vector<SurfaceLine> lines;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        const auto plane = [&](const Vec2& q) { return scene.surfaces[0].frame.to_plane({q.x, q.y, 0}); };
        lines.push_back({the_floor, LineKind::ev, plane(ends[i]), plane(ends[i + 1])});
    }
    const std::vector<Rgb> E{exitance};
    return measure_jumps(scene, direct, E, lines);
}

/// ∫ dt / (π (1 + u² + t²)²) over the lamp's length seen from y: the factor of a line of the lamp at distance u.
double strip(double u, double y)
{
    const double D2 = 1 + u * u, D = std::sqrt(D2);
    const auto primitive = [&](double t) { return t / (2 * D2 * (D2 + t * t)) + std::atan(t / D) / (2 * D2 * D); };
    return (primitive(1 - y) - primitive(-1 - y)) / std::numbers::pi;
}

// From x on the floor the blocker's edge is seen against the lamp at c = −m x, m = (1 − ¼)/¼ = 3. Where c passes the
// lamp's edge s: dF/dx jumps by m K(s − x), d²F/dx² by ((1 + m)² − 1) K′(s − x), F itself doesn't.
TEST(MeasureJumps, BothBordersOfAPenumbraHaveTheirClosedForms)
{
    const Scene scene = half_shaded_floor();
    const double x = 0.1 / 3, m = 3, u = 0.1 + x;
    const std::vector<Discontinuity> found = measured(scene, {{-x, -1}, {-x, 1}, {x, 1}, {x, -1}});
    ASSERT_EQ(found.size(), 2U);
    // At the lines' middle.
    const double slope = m * strip(u, 0);
    const double second = ((1 + m) * (1 + m) - 1) * std::abs(strip(u + 1e-4, 0) - strip(u - 1e-4, 0)) / 2e-4;
    for (const Discontinuity& line : found) {
        const double B = rho * glm::length(exitance);
        // Of a parabola over a few times 1e-5 of the diameter: an error of its cube for the value, then of its square
        // and of itself.
        EXPECT_LT(line.value, 1e-8 * B);
        EXPECT_NEAR(line.slope, B * slope, 1e-6 * B * slope);
        EXPECT_NEAR(line.second, B * second, 1e-2 * B * second);
    }
}

// A wall stands on the line and hides the lamp from one side: the other's factor is that of four corner rectangles,
// ½π⁻¹ (X/√(1+X²) atan(Y/√(1+X²)) + Y/√(1+Y²) atan(X/√(1+Y²))).
TEST(MeasureJumps, AtAWallsFootAllTheLightIsTheJump)
{
    Scene scene = lit_floor(-2, {0.3, -0.4}, {0.7, 0.4});
    testing::add_surface(scene, {{0, -2, 0}, {0, 2, 0}, {0, 2, 3}, {0, -2, 3}}, 2);
    testing::add_surface(scene, {{0, 2, 0}, {0, -2, 0}, {0, -2, 3}, {0, 2, 3}}, 2);
    const auto corner = [](double X, double Y) {
        const double p = std::sqrt(1 + X * X), q = std::sqrt(1 + Y * Y);
        return (X / p * std::atan(Y / p) + Y / q * std::atan(X / q)) / (2 * std::numbers::pi);
    };
    const std::vector<Discontinuity> found = measured(scene, {{0, -0.5}, {0, 0.5}});
    ASSERT_EQ(found.size(), 1U);
    const double expected = rho * glm::length(exitance) * 2 * (corner(0.7, 0.4) - corner(0.3, 0.4));
    EXPECT_NEAR(found[0].value, expected, 1e-9 * expected);
    EXPECT_GT(found[0].slope, 0);
}

TEST(MeasureJumps, WhereTheLightIsSmoothOrThereIsNoneLinesAreLeftOut)
{
    const Scene scene = half_shaded_floor();
    EXPECT_TRUE(measured(scene, {{-0.5, -1}, {-0.5, 1}, {-1.3, 0.2}, {-0.2, 0.7}, {0.5, -1}, {0.5, 1}}).empty());
    // In the middle of a narrow penumbra the light is smooth, but steep: what is left of it costs next to nothing.
    const double x = 0.1 / 3;
    const std::vector<Discontinuity> border = measured(scene, {{x, -0.3}, {x, 0.3}});
    ASSERT_EQ(border.size(), 1U);
    for (const Discontinuity& line : measured(scene, {{0.01, -0.3}, {0.01, 0.3}}))
        for (const double error : {1e-5, 1e-8, 1e-11})
            EXPECT_LT(elements_saved(line, error), 0.1 * elements_saved(border[0], error));
}

TEST(MeasureJumps, LinesOnTheBorderAreLeftOut)
{
    const double x = 0.1 / 3;
    const Scene scene = half_shaded_floor(-x);
    EXPECT_TRUE(measured(scene, {{-x, -1}, {-x, 1}}).empty());
    EXPECT_EQ(measured(scene, {{x, -1}, {x, 1}}).size(), 1U);
}

Discontinuity line_with(double length, double value, double slope, double second)
{
    return {{the_floor, LineKind::ev, {0.3, 0.2}, {0.3, 0.2 + length}}, value, slope, second};
}

// An element of size h across the jump has the squared error J² h^(2k+2) / c: its h put back in gives the error asked.
TEST(ElementsSaved, IsTheNumberOfElementsAlongTheLineThatHaveTheError)
{
    const double error = 3e-7, J = 0.7, length = 0.4;
    const auto size = [&](const Discontinuity& line) { return 2 * length / elements_saved(line, error); };
    EXPECT_NEAR(J * J * std::pow(size(line_with(length, J, 0, 0)), 2) / 12, error, 1e-12 * error);
    EXPECT_NEAR(J * J * std::pow(size(line_with(length, 0, J, 0)), 4) / 48, error, 1e-12 * error);
    EXPECT_NEAR(J * J * std::pow(size(line_with(length, 0, 0, J)), 6) / 600, error, 1e-12 * error);
    // The costliest derivative counts; a line of twice the length costs twice as much; no jump costs nothing.
    EXPECT_EQ(
        elements_saved(line_with(length, J, J, J), error),
        std::max({elements_saved(line_with(length, J, 0, 0), error), elements_saved(line_with(length, 0, J, 0), error),
                  elements_saved(line_with(length, 0, 0, J), error)}));
    EXPECT_NEAR(elements_saved(line_with(2 * length, 0, J, 0), error),
                2 * elements_saved(line_with(length, 0, J, 0), error), 1e-9);
    EXPECT_LT(elements_saved(line_with(length, 0, 0, 0), error), 1e-200);
}

class WorthwhileLines : public ::testing::Test {
protected:
    WorthwhileLines() : scene(lit_floor(-2, {-0.1, -1}, {0.1, 1})), mesh(triangulate(scene, {.max_edge = 0.5}))
    {
        error.total = 1;
        error.relative = 0.1;
        n = static_cast<double>(mesh.patch_count());
    }

    /// Costs so many elements at the error that the mesh has now.
    Discontinuity costing(double elements, double y) const
    {
        const double length = 1, h = 2 * length / elements, element_error = error.total * error.total / n;
        return {{the_floor, LineKind::ev, {1, y}, {2, y}}, 0, std::sqrt(48 * element_error) / (h * h), 0};
    }

    std::vector<double> chosen(const std::vector<Discontinuity>& lines, double budget, double target = 0) const
    {
        std::vector<double> ys;
        for (const SurfaceLine& line : worthwhile_lines(scene, mesh, error, lines, static_cast<std::size_t>(budget * n),
                                                        target, {.least_saving = 6}))
            ys.push_back(line.start.y);
        return ys;
    }

    Scene scene;
    PatchMesh mesh;
    ErrorEstimate error;
    double n = 0;
};

TEST_F(WorthwhileLines, ThoseThatSaveMostComeFirstAndContactsBeforeAll)
{
    Discontinuity contact{{the_floor, LineKind::contact, {1, 0.9}, {2, 0.9}}};
    const std::vector<Discontinuity> lines{costing(7, 0.1), costing(5.9, 0.2), costing(70, 0.3), contact,
                                           costing(9, 0.4)};
    EXPECT_EQ(chosen(lines, 1), (std::vector{0.9, 0.3, 0.4, 0.1}));
}

// As if the squared error fell like 1/N²: at k times the patches an element's is k⁻³ of what it is, and a line with a
// kink costs k^(3/4) times as many elements.
TEST_F(WorthwhileLines, AGreaterBudgetWantsMoreLinesUnlessTheTargetIsMetBefore)
{
    const std::vector<Discontinuity> lines{costing(1, 0.1), costing(0.7, 0.2), costing(2, 0.3)};
    EXPECT_EQ(chosen(lines, 1), (std::vector<double>{}));
    EXPECT_EQ(chosen(lines, 4.5), (std::vector{0.3}));
    EXPECT_EQ(chosen(lines, 16), (std::vector{0.3, 0.1}));
    EXPECT_EQ(chosen(lines, 20), (std::vector{0.3, 0.1, 0.2}));
    // With the error as it is good enough, elements share it: k¹ᐟ⁴.
    EXPECT_EQ(chosen(lines, 20, 0.1), (std::vector<double>{}));
    EXPECT_EQ(chosen(lines, 100, 0.1), (std::vector{0.3}));
}

TEST_F(WorthwhileLines, WhatTheMeshHoldsIsNotGivenAgain)
{
    Discontinuity contact{{the_floor, LineKind::contact, {1, 0.9}, {2, 0.9}}};
    const std::vector<Discontinuity> lines{costing(70, 0.1), contact, costing(50, 0.3)};
    RefinementPlan plan;
    plan.lines = {lines[0].line, lines[1].line};
    auto counts = count_lines(scene, mesh, lines);
    EXPECT_EQ(counts[static_cast<std::size_t>(LineKind::ev)].found, 2U);
    EXPECT_EQ(counts[static_cast<std::size_t>(LineKind::ev)].inserted, 0U);
    mesh = refine(scene, mesh, plan, {}).mesh;
    EXPECT_EQ(chosen(lines, 1), (std::vector{0.3}));
    counts = count_lines(scene, mesh, lines);
    EXPECT_EQ(counts[static_cast<std::size_t>(LineKind::ev)].inserted, 1U);
    EXPECT_EQ(counts[static_cast<std::size_t>(LineKind::contact)].found, 1U);
    EXPECT_EQ(counts[static_cast<std::size_t>(LineKind::contact)].inserted, 1U);
}

}  // namespace
}  // namespace patchlight
