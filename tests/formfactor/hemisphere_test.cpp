#include "formfactor/hemisphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

// The lecture's rule ΔF = (2π/k²) sin 2θ sums to Δθ·cot Δθ, not to 1 (design.md §7).
TEST(Hemisphere, TheLecturesGridSumsToItsKnownValue)
{
    for (const int k : {8, 16, 64, 256}) {
        const double step = 2 * std::numbers::pi / k;
        EXPECT_NEAR(regular_grid(k, false).sum, step / std::tan(step), 1e-12) << k;
    }
    EXPECT_NEAR(regular_grid(64, false).sum, 0.9968, 5e-5);
}

TEST(Hemisphere, ExactRingsAndStrataSumToOne)
{
    for (const int k : {8, 16, 64}) EXPECT_NEAR(regular_grid(k, true).sum, 1, 1e-12);
    for (const int rays : {16, 100, 512, 4096}) {
        const auto sets = hemisphere_sets({.rays = rays}, 3);
        for (const auto& set : sets) {
            EXPECT_NEAR(set.sum, 1, 1e-12);
            EXPECT_GE(set.size(), static_cast<std::size_t>(rays));
            EXPECT_EQ(set.size() % 8, 0U) << "whole packets";
        }
    }
}

// The directions carry their own check: ∫ cos/π · (z) dω = 2/3 and the mean of x, y is 0.
TEST(Hemisphere, DirectionsAreUnitAndHaveTheMomentsOfTheCosine)
{
    for (const auto directions : {HemisphereDirections::stratified, HemisphereDirections::regular_grid}) {
        const auto set = hemisphere_sets({.directions = directions, .rays = 4096}, 1).front();
        double x = 0, y = 0, z = 0;
        for (std::size_t i = 0; i < set.size(); ++i) {
            const double f = static_cast<double>(set.factor[i]);
            x += f * static_cast<double>(set.x[i]);
            y += f * static_cast<double>(set.y[i]);
            z += f * static_cast<double>(set.z[i]);
            EXPECT_NEAR(std::hypot(set.x[i], set.y[i], set.z[i]), 1, 1e-6);
            EXPECT_GT(set.z[i], 0) << "a ray must leave its surface";
        }
        // Strata of 4,096 rays: the error is far below n^-1/2 = 1.6e-2.
        EXPECT_NEAR(x, 0, 1e-3);
        EXPECT_NEAR(y, 0, 1e-3);
        EXPECT_NEAR(z, 2.0 / 3, 1e-3);
    }
}

TEST(Hemisphere, OriginsLieInTheTriangleAndSpreadEvenly)
{
    const auto set = hemisphere_sets({.rays = 4096}, 1).front();
    double b0 = 0, b1 = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
        EXPECT_GE(set.b0[i], 0);
        EXPECT_GE(set.b1[i], 0);
        EXPECT_LE(set.b0[i] + set.b1[i], 1.000001);
        b0 += static_cast<double>(set.b0[i]) / static_cast<double>(set.size());
        b1 += static_cast<double>(set.b1[i]) / static_cast<double>(set.size());
    }
    EXPECT_NEAR(b0, 1.0 / 3, 2e-3);
    EXPECT_NEAR(b1, 1.0 / 3, 2e-3);
}

TEST(Hemisphere, GridsThatCannotBeAreRefused)
{
    EXPECT_THROW(regular_grid(6, true), std::invalid_argument);
    EXPECT_THROW(regular_grid(4, true), std::invalid_argument);
}

}  // namespace
}  // namespace patchlight
