#include "apps/imaging/exposure.h"
#include "apps/imaging/false_color.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

/// x over a strip of one surface, from 0 to 1.
QuantityMap ramp(int width, int height)
{
    QuantityMap map{1, ScalarImage(width, height), {}, {}};
    map.surface.resize(map.values.values.size(), 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) map.values.at(x, y) = static_cast<float>(x) / static_cast<float>(width - 1);
    }
    return map;
}

TEST(ColorTables, AreThePublishedOnesInSrgb)
{
    // matplotlib's first and last colours; the library rounds to three or four digits.
    const ColorTable viridis = color_table("viridis"), magma = color_table("magma");
    ASSERT_EQ(viridis.size(), 256U);
    for (const auto& [found, known] : {std::pair(viridis.front(), Rgb(0.267004, 0.004874, 0.329415)),
                                       {viridis.back(), Rgb(0.993248, 0.906157, 0.143936)},
                                       {magma.front(), Rgb(0.001462, 0.000466, 0.013866)},
                                       {magma.back(), Rgb(0.987053, 0.991438, 0.749504)}}) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], known[k], 0.01);
    }
    EXPECT_THROW(color_table("no such map"), std::runtime_error);
}

TEST(ColorTables, DivergingHasAMiddleOfItsOwn)
{
    const ColorTable table = diverging_colors();
    ASSERT_EQ(table.size() % 2, 1U);
    EXPECT_EQ(table[table.size() / 2], Rgb(247.0 / 255));
    EXPECT_GT(table.front().b, 2 * table.front().r);
    EXPECT_GT(table.back().r, 2 * table.back().b);
}

TEST(ValueScales, PutValuesBetweenTheirEnds)
{
    const ValueScale linear{ScaleKind::linear, 2, 6}, log{ScaleKind::logarithmic, 0.01, 100};
    EXPECT_DOUBLE_EQ(linear.position(3), 0.25);
    EXPECT_EQ(linear.position(-1), 0);
    EXPECT_EQ(linear.position(9), 1);
    EXPECT_DOUBLE_EQ(log.position(1), 0.5);
    EXPECT_EQ(log.position(0), 0);
    EXPECT_EQ(log.position(-5), 0);
    EXPECT_TRUE(std::isnan(linear.position(std::nan(""))));
    EXPECT_TRUE(std::isnan(log.position(std::nan(""))));
}

TEST(ValueScales, TicksAreRoundAndNotTooMany)
{
    EXPECT_EQ(round_values({ScaleKind::linear, 0, 800}, 9),
              (std::vector<double>{0, 100, 200, 300, 400, 500, 600, 700, 800}));
    EXPECT_EQ(round_values({ScaleKind::linear, 0, 0.3}, 4), (std::vector<double>{0, 0.1, 0.2, 0.3}));
    EXPECT_EQ(round_values({ScaleKind::linear, -0.5, 0.5}, 3), (std::vector<double>{-0.5, 0, 0.5}));
    EXPECT_EQ(round_values({ScaleKind::logarithmic, 0.01, 100}, 5), (std::vector<double>{0.01, 0.1, 1, 10, 100}));
    EXPECT_EQ(round_values({ScaleKind::logarithmic, 10, 100}, 4), (std::vector<double>{10, 20, 50, 100}));
    EXPECT_TRUE(round_values({ScaleKind::linear, 0, 1}, 0).empty());
    for (const double high : {1e-12, 0.7, 3.3, 12345.0, 1e12}) {
        for (const int most : {1, 2, 5, 100}) {
            for (const ScaleKind kind : {ScaleKind::linear, ScaleKind::logarithmic}) {
                const auto ticks = round_values({kind, high * 1e-7, high}, most);
                EXPECT_LE(ticks.size(), static_cast<std::size_t>(most));
                EXPECT_TRUE(std::ranges::is_sorted(ticks));
            }
        }
    }
}

TEST(ValueScales, FitWhatMostOfThePictureHas)
{
    std::vector<float> values(1000, 7.0F);
    values[3] = 1e9F;
    values[4] = std::numeric_limits<float>::quiet_NaN();
    values[5] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(fitting_scale(values, ScaleKind::linear).high, 8);
    EXPECT_EQ(fitting_scale(values, ScaleKind::linear).low, 0);
    const ValueScale log = fitting_scale(values, ScaleKind::logarithmic);
    EXPECT_EQ(log.low, 6);
    EXPECT_EQ(log.high, 8);
    for (const ScaleKind kind : {ScaleKind::linear, ScaleKind::logarithmic}) {
        for (const std::vector<float>& none : {std::vector<float>{}, {nothing_shown}, {0, 0}, {-1}}) {
            const ValueScale scale = fitting_scale(none, kind);
            EXPECT_EQ(scale.high, 1);
            EXPECT_LT(scale.low, 1);
            EXPECT_TRUE(kind == ScaleKind::linear || scale.low > 0);
        }
    }
    EXPECT_EQ(round_up(0.1), 0.1);
    EXPECT_EQ(round_up(0.11), 0.15);
    EXPECT_EQ(round_up(9.1), 10);
    EXPECT_EQ(round_down(0.29), 0.25);
}

TEST(FalseColor, NoValueIsGreyAndTheEndsAreTheTables)
{
    QuantityMap map = ramp(3, 1);
    map.values.at(1, 0) = nothing_shown;
    const FalseColor how{color_table("inferno"), {ScaleKind::linear, 0.25, 0.75}};
    const Image image = false_color(map, how);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(image.at(0, 0)[k], how.table.front()[k], 1e-5);
        EXPECT_NEAR(image.at(2, 0)[k], how.table.back()[k], 1e-5);
    }
    EXPECT_EQ(image.at(1, 0).r, image.at(1, 0).b);
    EXPECT_EQ(note_on(map), "grey: no value");
    EXPECT_EQ(note_on(ramp(3, 1)), "");
}

TEST(FalseColor, AnIsolineStandsAtItsValueAndIsAsWideAsItSays)
{
    // A table of one grey: what differs from it is the line.
    FalseColor how{ColorTable(2, Rgb(0.9)), {ScaleKind::linear, 0, 1}, {0.5}};
    const Image image = false_color(ramp(101, 3), how);
    double covered = 0, middle = 0;
    const double full = srgb_decoded(0.9);
    for (int x = 0; x < 101; ++x) {
        const double share = 1 - srgb_decoded(image.at(x, 1).r) / full;
        covered += share;
        middle += share * x;
    }
    // .9 pixels; one sample a pixel catches that much, give or take its rounding to pixel centres.
    EXPECT_NEAR(covered, 0.9, 0.21);
    EXPECT_NEAR(middle / covered, 50, 1e-4);
}

TEST(FalseColor, AnIsolineEndsWhereAnotherSurfaceBegins)
{
    QuantityMap map = ramp(20, 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 20; ++x) {
            map.values.at(x, y) = x < 10 ? 0.2F : 0.8F;  // flat on both sides of the edge
            map.surface[static_cast<std::size_t>(y * 20 + x)] = x < 10 ? 0 : 1;
        }
    }
    const FalseColor how{ColorTable(2, Rgb(0.9)), {ScaleKind::linear, 0, 1}, {0.5}};
    for (const float value : false_color(map, how).rgb) EXPECT_NEAR(value, 0.9, 1e-5);
}

TEST(FalseColor, NoIsolineIsDrawnWhereTheScaleBegins)
{
    const FalseColor how{ColorTable(2, Rgb(0.9)), {ScaleKind::linear, 0, 1}, {0}};
    for (const float value : false_color(ramp(20, 4), how).rgb) EXPECT_NEAR(value, 0.9, 1e-5);
}

TEST(FalseColor, TheLegendHoldsTheWholeTableAndLeavesThePictureAlone)
{
    const FalseColor how{color_table("viridis"), {ScaleKind::linear, 0, 1}};
    Image picture(300, 100);
    for (float& value : picture.rgb) value = 0.5F;
    const Image result = with_legend(picture, how, "title");
    EXPECT_EQ(result.width, 300);
    EXPECT_GT(result.height, 100);
    EXPECT_TRUE(std::equal(picture.rgb.begin(), picture.rgb.end(), result.rgb.begin()));
    const auto holds = [&](const Rgb& color) {
        for (int y = 100; y < result.height; ++y) {
            for (int x = 0; x < 300; ++x) {
                if (glm::length(result.at(x, y) - color) < 0.03) return true;
            }
        }
        return false;
    };
    EXPECT_TRUE(holds(how.table.front()));
    EXPECT_TRUE(holds(how.table[128]));
    EXPECT_TRUE(holds(how.table.back()));
    EXPECT_EQ(with_legend(Image(1, 1), how, "title", "note").width, 1) << "however small";
}

/// The floor (ρ = .5, no E) of a known light, seen from above.
class QuantityTest : public ::testing::Test {
protected:
    QuantityTest()
        : mesh_(grid_mesh(scene_, 4)), locator_(mesh_), caster_(scene_), B_(mesh_.patch_count()),
          vertex_B_(mesh_.vertex_count()), eta_(mesh_.patch_count())
    {
        for (VertexId v : mesh_.vertices()) vertex_B_[v] = {1, 2, 3};
        for (PatchId p : mesh_.patches()) {
            B_[p] = {2, 4, 6};
            eta_[p] = 0.25;
        }
        view_.from = {0.5, 0.5, 0.9};
        view_.forward = {0, 0, -1};
        view_.up = {0, 1, 0};
        view_.vertical_fov = 40;
    }

    float seen(Quantity quantity, Shade shade = Shade::gouraud)
    {
        const ViewHits hits = trace_view(caster_, view_, 9, 9, 1);
        return quantity_map({scene_, mesh_, locator_, B_, vertex_B_}, eta_, hits, quantity, shade).values.at(3, 5);
    }

    Scene scene_ = floor_and_lamp();
    PatchMesh mesh_;
    PatchLocator locator_;
    RayCaster caster_;
    Radiosity B_;
    VertexRadiosity vertex_B_;
    PatchField<double> eta_;
    View view_;
};

TEST_F(QuantityTest, LuxIsSixHundredEightyThreeTimesTheLuminanceOfTheIrradiance)
{
    const double Y = 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3;
    // Single precision in the map.
    EXPECT_NEAR(seen(Quantity::radiosity) / Y, 1, 1e-6);
    EXPECT_NEAR(seen(Quantity::irradiance) / (Y / 0.5), 1, 1e-6);
    EXPECT_NEAR(seen(Quantity::lux) / (683 * Y / 0.5), 1, 1e-6);
    EXPECT_NEAR(seen(Quantity::lux, Shade::flat) / (683 * 2 * Y / 0.5), 1, 1e-6);
}

TEST_F(QuantityTest, WhatASurfaceEmitsIsNoIrradiance)
{
    scene_.materials[0].emission = {0.5, 1, 1.5};
    EXPECT_NEAR(seen(Quantity::irradiance), 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3, 1e-6);
}

TEST_F(QuantityTest, ABandThatIsNotReflectedLeavesNoValue)
{
    scene_.materials[0].reflectance = {0.5, 0, 0.5};
    EXPECT_TRUE(std::isnan(seen(Quantity::lux)));
    EXPECT_FALSE(std::isnan(seen(Quantity::radiosity)));
}

TEST_F(QuantityTest, ErrorIsARootMeanSquareOverTheElement)
{
    const double area = 1.0 / 32;
    EXPECT_NEAR(seen(Quantity::size), area, 1e-8);
    EXPECT_NEAR(seen(Quantity::error), 0.25 / std::sqrt(area), 1e-6);
}

TEST_F(QuantityTest, TheLampDoesNotChooseTheScale)
{
    view_.from = {0.5, -3, 0.5};
    view_.forward = {0, 1, 0};
    view_.up = {0, 0, 1};
    scene_.materials[1].emission = Rgb(1e6);
    const ViewHits hits = trace_view(caster_, view_, 64, 64, 1);
    const QuantityMap map =
        quantity_map({scene_, mesh_, locator_, B_, vertex_B_}, eta_, hits, Quantity::radiosity, Shade::gouraud);
    const std::vector<float> values = values_for_scale(scene_, map);
    EXPECT_LT(values.size(), map.values.values.size()) << "the background isn't counted either";
    for (const float value : values) EXPECT_LT(value, 10);
}

}  // namespace
}  // namespace patchlight
