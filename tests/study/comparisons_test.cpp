#include "apps/study/comparisons.h"
#include "tests/study/made_study.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patchlight {
namespace {

using At = StudyComparison::At;

/// A handful of logarithms and one exponential.
constexpr double rounding = 1e-13;

const std::vector<CurvePoint> inverse{{400, 0.25}, {100, 1}, {1000, 0.1}};  // error = 100/x, in no order

TEST(ComparisonsTest, BetweenPointsTheCurveIsStraightOnLogAxes)
{
    EXPECT_NEAR(error_at(inverse, 200).value(), 0.5, rounding);
    EXPECT_NEAR(error_at(inverse, 500).value(), 0.2, rounding);
    EXPECT_EQ(error_at(inverse, 400).value(), 0.25) << "at a point it is the point's";
    EXPECT_NEAR(first_with(inverse, 0.5).value(), 200, 200 * rounding);
    EXPECT_EQ(first_with(inverse, 0.1).value(), 1000);
}

TEST(ComparisonsTest, NothingIsExtrapolated)
{
    EXPECT_FALSE(error_at(inverse, 99.999).has_value());
    EXPECT_FALSE(error_at(inverse, 1000.001).has_value());
    EXPECT_FALSE(first_with(inverse, 0.0999).has_value());
    EXPECT_FALSE(first_with(inverse, 1.001).has_value()) << "it may have had that error earlier";
    EXPECT_FALSE(error_at({}, 1).has_value());
    EXPECT_FALSE(first_with({}, 1).has_value());
    const std::vector<CurvePoint> one{{5, 1}};
    EXPECT_EQ(error_at(one, 5).value(), 1);
    EXPECT_FALSE(error_at(one, 6).has_value());
}

TEST(ComparisonsTest, AnErrorThatRisesAgainIsFirstReachedWhereItFalls)
{
    const std::vector<CurvePoint> curve{{1, 1}, {2, 0.5}, {3, 0.8}, {4, 0.25}};
    EXPECT_EQ(first_with(curve, 0.5).value(), 2);
    EXPECT_NEAR(first_with(curve, 1 / std::sqrt(2.0)).value(), std::sqrt(2.0), rounding);
}

TEST(ComparisonsTest, OfEqualPlacesTheLeastErrorCountsAndZeroIsNoPoint)
{
    const std::vector<CurvePoint> curve{{1, 1}, {2, 0.9}, {2, 0.5}, {3, 0}};
    EXPECT_EQ(error_at(curve, 2).value(), 0.5);
    EXPECT_FALSE(error_at(curve, 2.5).has_value());
}

TEST(ComparisonsTest, SeriesAreHeldToTheBest)
{
    StudyResult study = testing::made_study();
    study.comparisons = {{At::elements, {1000, 3000, 100}}, {At::error, {0.05}}};
    const auto rows = compared(study, false);
    ASSERT_EQ(rows.size(), 4U);
    // 1000 elements: 0.1·2^−½ and 0.1/2.
    EXPECT_NEAR(rows[0].values[0].value.value(), 0.1 / std::sqrt(2.0), rounding);
    EXPECT_NEAR(rows[0].values[1].value.value(), 0.05, rounding);
    EXPECT_NEAR(rows[0].values[0].to_best.value(), std::sqrt(2.0), rounding);
    EXPECT_EQ(rows[0].values[1].to_best.value(), 1);
    EXPECT_NEAR(rows[1].values[1].value.value(), 0.1 / 6, rounding);
    EXPECT_FALSE(rows[2].values[0].value.has_value()) << "cells' own cycles at 100 elements aren't the series'";
    // An error of 0.05: 500·2² and 500·2 elements.
    EXPECT_EQ(rows[3].quantity, ComparedQuantity::elements);
    EXPECT_NEAR(rows[3].values[0].value.value(), 2000, 2000 * rounding);
    EXPECT_NEAR(rows[3].values[1].value.value(), 1000, 1000 * rounding);
    EXPECT_NEAR(rows[3].values[0].to_best.value(), 2, rounding);
}

TEST(ComparisonsTest, WhereASeriesHasOneCellItsCyclesCount)
{
    StudyResult study = testing::made_study();
    study.along.clear();
    study.comparisons = {{At::elements, {200}}};
    const auto rows = compared(study, false);
    ASSERT_EQ(rows[0].values.size(), 8U);
    EXPECT_NEAR(rows[0].values[4].value.value(), 0.25, rounding) << "between 100 and 500 elements";
    EXPECT_EQ(rows[0].values[5].value.value(), study.cells[5].cycles[0].error.value());
    EXPECT_FALSE(rows[0].values[6].value.has_value()) << "begins at 400";
}

TEST(ComparisonsTest, TheClockIsAskedOnlyWhenToldSo)
{
    StudyResult study = testing::made_study();
    study.comparisons = {{At::seconds, {1}}, {At::error, {0.05}}};
    EXPECT_EQ(compared(study, false).size(), 1U);
    const auto rows = compared(study, true);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_NEAR(rows[0].values[1].value.value(), 0.05, rounding) << "a second is 1000 elements here";
    EXPECT_EQ(rows[2].quantity, ComparedQuantity::seconds);
    EXPECT_NEAR(rows[2].values[0].value.value(), 2, 2 * rounding);
}

TEST(ComparisonsTest, ScenesAreNotComparedWithEachOther)
{
    StudyResult study = testing::made_study();
    for (std::size_t c = 4; c < 8; ++c) study.cells[c].cell.scene = "other.obj";
    study.comparisons = {{At::elements, {1000}}};
    const auto rows = compared(study, false);
    ASSERT_EQ(rows.size(), 2U);
    for (const ComparedRow& row : rows) {
        ASSERT_EQ(row.values.size(), 1U);
        EXPECT_EQ(row.values[0].to_best.value(), 1);
    }
    EXPECT_EQ(rows[1].scene, "other.obj");
}

}  // namespace
}  // namespace patchlight
