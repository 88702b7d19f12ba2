#include "apps/study/rates.h"
#include "tests/study/made_study.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace patchlight {
namespace {

using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Logarithms round at 1e-16 each; a slope over decades keeps 14 digits.
constexpr double rounding = 1e-13;

TEST(RatesTest, APowerLawHasItsOwnOrderEverywhere)
{
    for (const double order : {0.5, 1.0, 2.0, -0.25}) {
        std::vector<CurvePoint> points;
        for (const double n : {10.0, 35.0, 400.0, 1e6}) points.push_back({n, 3 * std::pow(n, -order)});
        const FittedOrder fit = fitted_order(points);
        ASSERT_TRUE(fit.order.has_value());
        EXPECT_NEAR(*fit.order, order, rounding);
        EXPECT_NEAR(fit.standard_error.value(), 0, rounding);
        EXPECT_EQ(fit.points, 4U);
        EXPECT_EQ(fit.note, "");
        ASSERT_EQ(fit.local.size(), 4U);
        EXPECT_FALSE(fit.local[0].has_value());
        for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(fit.local[i].value(), order, rounding);
    }
}

TEST(RatesTest, LeastSquaresByHand)
{
    // Logarithms to base e: x = 0, 1, 2; y = 0, -1, -1. Slope −1/2, residuals 1/6, −1/3, 1/6: √(1/6 / 1 / 2).
    const double e = std::exp(1.0);
    const std::vector<CurvePoint> points{{1, 1}, {e, 1 / e}, {e * e, 1 / e}};
    const FittedOrder fit = fitted_order(points);
    EXPECT_NEAR(fit.order.value(), 0.5, rounding);
    EXPECT_NEAR(fit.standard_error.value(), std::sqrt(1.0 / 12), rounding);
    EXPECT_NEAR(fit.local[1].value(), 1, rounding);
    EXPECT_NEAR(fit.local[2].value(), 0, rounding);
}

TEST(RatesTest, WithoutTwoPlacesThereIsNoOrderAndNoNaN)
{
    const FittedOrder none = fitted_order({});
    EXPECT_FALSE(none.order.has_value());
    EXPECT_EQ(none.note, "no point");
    const std::vector<CurvePoint> one{{100, 0.1}};
    EXPECT_FALSE(fitted_order(one).order.has_value());
    EXPECT_EQ(fitted_order(one).note, "one point");
    const std::vector<CurvePoint> equal{{100, 0.1}, {100, 0.2}, {100, 0.3}};
    const FittedOrder fit = fitted_order(equal);
    EXPECT_FALSE(fit.order.has_value());
    EXPECT_FALSE(fit.standard_error.has_value());
    EXPECT_FALSE(fit.local[1].has_value());
    EXPECT_EQ(fit.note, "all points at one place");
}

TEST(RatesTest, WhatLogarithmsDontKnowIsLeftOutAndSaid)
{
    const std::vector<CurvePoint> points{{100, 0.1}, {200, 0}, {300, nan}, {0, 0.1}, {400, 0.05}, {500, -1}};
    const FittedOrder fit = fitted_order(points);
    EXPECT_NEAR(fit.order.value(), 0.5, rounding);
    EXPECT_EQ(fit.points, 2U);
    EXPECT_FALSE(fit.standard_error.has_value()) << "two points are always on a line";
    EXPECT_THAT(fit.note, HasSubstr("4 of 6 left out"));
    EXPECT_FALSE(fit.local[1].has_value());
    EXPECT_NEAR(fit.local[4].value(), 0.5, rounding) << "from the last one that counts";
    const std::vector<CurvePoint> zeros{{100, 0}, {200, 0}};
    EXPECT_EQ(fitted_order(zeros).note, "2 of 2 left out: no error, or 0; no point");
}

TEST(RatesTest, SeriesRunAlongTheirAxisAlone)
{
    const StudyResult study = testing::made_study();
    const auto rates = rates_of(study);
    ASSERT_EQ(rates.size(), 2U);
    EXPECT_EQ(rates[0].series.name, "refine=intensity");
    EXPECT_EQ(rates[1].series.name, "refine=both");
    EXPECT_EQ(rates[1].series.cells, (std::vector<std::size_t>{4, 5, 6, 7}));
    EXPECT_NEAR(rates[0].by_elements.order.value(), 0.5, rounding);
    EXPECT_NEAR(rates[1].by_elements.order.value(), 1.0, rounding);
    EXPECT_NEAR(rates[1].by_seconds.order.value(), 1.0, rounding);
}

TEST(RatesTest, CellsThatDidNotRunToTheirEndDontCount)
{
    StudyResult study = testing::made_study();
    study.cells[4].status = CellStatus::unfinished;
    study.cells[4].cycles.back().error = 1e6;
    study.cells[5].status = CellStatus::failed;
    study.cells[5].cycles.clear();
    study.cells[6].status = CellStatus::not_converged;
    const auto rates = rates_of(study);
    EXPECT_EQ(rates[1].by_elements.points, 2U);
    EXPECT_NEAR(rates[1].by_elements.order.value(), 1.0, rounding);
    EXPECT_THAT(rates[1].by_elements.note, HasSubstr("2 of 4 left out"));
}

TEST(RatesTest, WithoutAnAxisEachCellIsASeriesAndScenesAreApart)
{
    StudyResult study = testing::made_study();
    study.along.clear();
    EXPECT_EQ(series_of(study).size(), 8U);
    EXPECT_EQ(rates_of(study)[0].by_elements.note, "one point");
    study = testing::made_study();
    study.cells[1].cell.scene = "other.obj";
    EXPECT_EQ(series_of(study).size(), 3U);
}

TEST(RatesTest, ScenesAreNamedWithoutTheirFolders)
{
    StudyResult study = testing::made_study();
    study.cells[0].cell.scene = "/home/somebody/room.obj";
    EXPECT_EQ(series_of(study)[0].scene, "room.obj");
    EXPECT_EQ(series_of(study).size(), 2U);
    study.axes.insert(study.axes.begin(), {"scene", {}});
    for (CellResult& cell : study.cells) cell.cell.values.insert(cell.cell.values.begin(), "a/room.obj");
    EXPECT_EQ(scene_name(study, study.cells[0]), "a/room.obj") << "as written, where there may be several";
}

TEST(RatesTest, WithoutAReferenceEstimatesStandIn)
{
    StudyResult study = testing::made_study();
    study.reference.kind = ReferenceKind::none;
    for (CellResult& cell : study.cells) cell.cycles.back().error.reset();
    EXPECT_NEAR(rates_of(study)[1].by_elements.order.value(), 1.0, rounding);
    study.reference.kind = ReferenceKind::path_traced;
    EXPECT_FALSE(rates_of(study)[1].by_elements.order.has_value()) << "not where errors should have been measured";
}

}  // namespace
}  // namespace patchlight
