#include "apps/study/gates.h"
#include "tests/study/made_study.h"

#include <gmock/gmock.h>

#include <limits>

namespace patchlight {
namespace {

using ::testing::HasSubstr;

std::size_t passed(const std::vector<GateResult>& results)
{
    std::size_t count = 0;
    for (const GateResult& r : results) count += r.passed ? 1 : 0;
    return count;
}

TEST(GatesTest, NoGatesGiveNoResults)
{
    EXPECT_TRUE(check_gates(testing::made_study()).empty());
}

TEST(GatesTest, EachCellAndEachSeriesIsHeldToItsBound)
{
    StudyResult study = testing::made_study();
    study.gates.min_rate = 0.7;
    study.gates.max_error = 0.06;
    study.gates.max_energy_residual = 1e-6;
    study.gates.min_effectivity = 2.0;
    study.gates.max_effectivity = 1.9;
    const auto results = check_gates(study);
    ASSERT_EQ(results.size(), 2U + 4 * 8U);
    EXPECT_EQ(results[0].gate, "min_rate");
    EXPECT_EQ(results[0].of, "refine=intensity");
    EXPECT_FALSE(results[0].passed);
    EXPECT_TRUE(results[1].passed);
    const auto of_gate = [&](std::size_t k) {
        return std::vector(results.begin() + 2 + 8 * static_cast<int>(k),
                           results.begin() + 10 + 8 * static_cast<int>(k));
    };
    // 0.1, 0.071, 0.05, 0.035 and 0.1, 0.05, 0.025, 0.0125.
    EXPECT_EQ(passed(of_gate(0)), 5U);
    EXPECT_EQ(passed(of_gate(1)), 8U) << "at the bound is within it";
    EXPECT_EQ(passed(of_gate(2)), 8U) << "estimates are twice the errors, to the bit";
    EXPECT_EQ(passed(of_gate(3)), 0U);
    EXPECT_EQ(of_gate(0)[0].of, "refine=intensity max-elements=500");
    EXPECT_EQ(of_gate(3)[7].value.value(), 2.0);
}

TEST(GatesTest, WhatCannotBeCheckedFailsAndSaysSo)
{
    StudyResult study = testing::made_study();
    study.gates.max_error = 1e9;
    study.cells[0].status = CellStatus::failed;
    study.cells[0].message = "out of memory";
    study.cells[1].status = CellStatus::waiting;
    study.cells[1].cycles.clear();
    study.cells[2].cycles.back().error.reset();
    study.cells[3].cycles.back().error = std::numeric_limits<double>::quiet_NaN();
    study.cells[4].cycles.back().error = std::numeric_limits<double>::infinity();
    const auto results = check_gates(study);
    ASSERT_EQ(results.size(), 8U);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_FALSE(results[i].passed) << i;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(results[i].value.has_value()) << i;
    EXPECT_EQ(results[0].message, "failed: out of memory");
    EXPECT_EQ(results[1].message, "waiting");
    EXPECT_THAT(results[2].message, HasSubstr("wasn't measured"));
    EXPECT_EQ(results[3].message, "not a number");
    EXPECT_EQ(passed(results), 3U);
}

TEST(GatesTest, EstimatesDontPassGatesForErrors)
{
    StudyResult study = testing::made_study();
    study.reference.kind = ReferenceKind::none;
    study.gates = {
        .min_rate = 0.1, .max_error = 1, .max_energy_residual = 1, .max_effectivity = {}, .min_effectivity = {}};
    const auto results = check_gates(study);
    ASSERT_EQ(results.size(), 2U + 8 + 8);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_THAT(results[i].message, HasSubstr("no reference"));
    EXPECT_EQ(passed(results), 8U) << "energy needs none";
}

TEST(GatesTest, ARateThatDoesNotExistFails)
{
    StudyResult study = testing::made_study();
    study.along.clear();
    study.gates.min_rate = -100.0;
    for (const GateResult& r : check_gates(study)) {
        EXPECT_FALSE(r.passed);
        EXPECT_EQ(r.message, "one point");
    }
}

TEST(GatesTest, NoErrorAtAllIsEstimatedWellByNone)
{
    StudyResult study = testing::made_study();
    study.gates.max_effectivity = 3.0;
    study.cells[0].cycles.back().error = 0;
    study.cells[0].cycles.back().estimated_error = 0;
    study.cells[1].cycles.back().error = 0;
    const auto results = check_gates(study);
    EXPECT_EQ(results[0].value.value(), 1);
    EXPECT_TRUE(results[0].passed) << "0/0";
    EXPECT_FALSE(results[1].passed) << "something over 0";
}

}  // namespace
}  // namespace patchlight
