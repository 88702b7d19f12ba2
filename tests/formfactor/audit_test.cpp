#include "formfactor/audit.h"

#include "formfactor/closed_form.h"

#include <gmock/gmock.h>

#include <limits>
#include <random>

namespace patchlight::testing {
namespace {

FormFactorMatrix matrix_of(const std::vector<std::vector<std::pair<std::uint32_t, double>>>& rows)
{
    FormFactorMatrix matrix;
    matrix.row_start = {0};
    for (const auto& row : rows) {
        for (const auto& [column, factor] : row) {
            matrix.columns.push_back(column);
            matrix.factors.push_back(factor);
        }
        matrix.row_start.push_back(matrix.columns.size());
    }
    return matrix;
}

/// The six sides of a closed box of 1 × 2 × 3, from the closed forms.
struct Box {
    FormFactorMatrix matrix;
    PatchField<double> areas{std::vector<double>{2, 2, 3, 3, 6, 6}};

    Box()
    {
        const double x = 1, y = 2, z = 3;
        const double zz = parallel_rectangles(x, y, z), yy = parallel_rectangles(x, z, y),
                     xx = parallel_rectangles(y, z, x);
        const double zy = perpendicular_rectangles(x, y, z), zx = perpendicular_rectangles(y, x, z);
        const double yz = perpendicular_rectangles(x, z, y), yx = perpendicular_rectangles(z, x, y);
        const double xz = perpendicular_rectangles(y, z, x), xy = perpendicular_rectangles(z, y, x);
        matrix = matrix_of({{{1, zz}, {2, zy}, {3, zy}, {4, zx}, {5, zx}},
                            {{0, zz}, {2, zy}, {3, zy}, {4, zx}, {5, zx}},
                            {{0, yz}, {1, yz}, {3, yy}, {4, yx}, {5, yx}},
                            {{0, yz}, {1, yz}, {2, yy}, {4, yx}, {5, yx}},
                            {{0, xz}, {1, xz}, {2, xy}, {3, xy}, {5, xx}},
                            {{0, xz}, {1, xz}, {2, xy}, {3, xy}, {4, xx}}});
    }
};

double entry(const FormFactorMatrix& matrix, std::size_t row, std::uint32_t column)
{
    for (std::size_t k = matrix.row_start[row]; k < matrix.row_start[row + 1]; ++k)
        if (matrix.columns[k] == column) return matrix.factors[k];
    return 0;
}

TEST(Audit, ExactFactorsOfABoxHaveNoDefect)
{
    const Box box;
    const FormFactorAudit result = audit(box.matrix, box.areas, true);
    EXPECT_EQ(result.rows, 6U);
    EXPECT_EQ(result.entries, 30U);
    EXPECT_LT(result.closure.worst, 1e-14);
    EXPECT_LT(result.reciprocity.worst, 1e-15);
    EXPECT_EQ(result.reciprocity.pairs, 15U);
    EXPECT_EQ(result.outside_count + result.non_finite_count + result.zero_rows + result.own_count, 0U);
}

TEST(Audit, AWrongRowIsNamed)
{
    Box box;
    for (std::size_t k = box.matrix.row_start[4]; k < box.matrix.row_start[5]; ++k) box.matrix.factors[k] *= 0.97;
    const FormFactorAudit result = audit(box.matrix, box.areas, true);
    EXPECT_EQ(result.closure.worst_patch, PatchId(4UL));
    EXPECT_NEAR(result.closure.worst, 0.03, 1e-14);
    EXPECT_NEAR(result.closure.mean, 0.03 / 6, 1e-14);
}

TEST(Audit, AFactorAboveOneIsNamed)
{
    Box box;
    box.matrix.factors[box.matrix.row_start[2] + 3] = 1.31;
    box.matrix.factors[box.matrix.row_start[5]] = -0.25;
    const FormFactorAudit result = audit(box.matrix, box.areas, true);
    ASSERT_EQ(result.outside_count, 2U);
    EXPECT_EQ(result.outside[0].row, PatchId(2UL));
    EXPECT_EQ(result.outside[0].column, PatchId(4UL));
    EXPECT_EQ(result.outside[0].factor, 1.31);
    EXPECT_EQ(result.outside[1].factor, -0.25);
}

TEST(Audit, ANonReciprocalPairIsNamed)
{
    Box box;
    const double before = entry(box.matrix, 1, 4);
    box.matrix.factors[box.matrix.row_start[1] + 3] = 1.5 * before;
    const FormFactorAudit result = audit(box.matrix, box.areas, true);
    EXPECT_EQ(result.reciprocity.first, PatchId(1UL));
    EXPECT_EQ(result.reciprocity.second, PatchId(4UL));
    EXPECT_NEAR(result.reciprocity.worst, 0.5 * before * 2 / 6, 1e-14) << "areas 2 and 6";
    EXPECT_NEAR(result.reciprocity.mean, result.reciprocity.worst / 15, 1e-14);
}

TEST(Audit, AFactorWithoutItsOppositeIsADefectWhicheverSideHasIt)
{
    const PatchField<double> areas(std::vector<double>{1, 1, 1});
    for (const auto& matrix :
         {matrix_of({{{1, 0.5}, {2, 0.5}}, {{0, 0.5}}, {}}), matrix_of({{{1, 0.5}}, {{0, 0.5}}, {{0, 0.5}}})}) {
        const FormFactorAudit result = audit(matrix, areas, false);
        EXPECT_EQ(result.reciprocity.pairs, 2U);
        EXPECT_EQ(result.reciprocity.first, PatchId(0UL));
        EXPECT_EQ(result.reciprocity.second, PatchId(2UL));
        EXPECT_GE(result.reciprocity.worst, 0.5);
    }
}

TEST(Audit, TheOrderOfColumnsDoesNotMatter)
{
    const Box box;
    FormFactorMatrix shuffled = box.matrix;
    for (std::size_t i = 0; i < 6; ++i) {
        std::reverse(shuffled.columns.begin() + 5 * i, shuffled.columns.begin() + 5 * (i + 1));
        std::reverse(shuffled.factors.begin() + 5 * i, shuffled.factors.begin() + 5 * (i + 1));
    }
    EXPECT_LT(audit(shuffled, box.areas, true).reciprocity.worst, 1e-15);
    sort_columns(shuffled);
    EXPECT_EQ(shuffled.columns, box.matrix.columns);
    EXPECT_EQ(shuffled.factors, box.matrix.factors);
}

TEST(Audit, WhatDoesNotCountAsADefect)
{
    const PatchField<double> areas(std::vector<double>{1, 1});
    FormFactorMatrix matrix = matrix_of({{{1, 0.2}}, {{0, 0.2}}});
    EXPECT_EQ(audit(matrix, areas, false).closure.worst, 0) << "open, and nobody knows what escapes";
    EXPECT_NEAR(audit(matrix, areas, true).closure.worst, 0.8, 1e-15);
    matrix.backs = PatchField<double>(2, 0.8);
    EXPECT_NEAR(audit(matrix, areas, true).closure.worst, 0, 1e-15);
    matrix.backs = PatchField<double>(2, 0.1);
    matrix.escaped = PatchField<double>(2, 0.7);
    EXPECT_NEAR(audit(matrix, areas, false).closure.worst, 0, 1e-15);
    EXPECT_NEAR(audit(matrix, areas, true).closure.worst, 0.7, 1e-15) << "nothing escapes from a closed scene";
    matrix.escaped = {};
    matrix.factors = {0.95, 0.2};
    EXPECT_NEAR(audit(matrix, areas, false).closure.worst, 0.05, 1e-15) << "more than there is";
}

TEST(Audit, NumbersThatAreNoneAndRowsWithoutAnyAreCounted)
{
    const PatchField<double> areas(std::vector<double>{1, 1, 1});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const FormFactorAudit result = audit(matrix_of({{{1, nan}}, {{0, 0.2}, {1, 0.1}}, {}}), areas, false);
    EXPECT_EQ(result.non_finite_count, 1U);
    EXPECT_EQ(result.non_finite[0].column, PatchId(1UL));
    EXPECT_EQ(result.zero_rows, 2U);
    EXPECT_EQ(result.own_count, 1U);
    EXPECT_THROW(audit(matrix_of({{{3, 0.1}}, {}, {}}), areas, false), std::invalid_argument);
    EXPECT_THROW(audit(matrix_of({{}}), areas, false), std::invalid_argument);
}

TEST(Audit, AnEmptyMatrixHasNothing)
{
    EXPECT_EQ(audit({}, {}, true).closure.mean, 0);
    FormFactorMatrix empty;
    EXPECT_EQ(repair_symmetrically(empty, {}, true).largest_row_change, 0);
}

/// Many patches of different areas that see most others, noisily: what a sampling method leaves.
struct Noisy {
    FormFactorMatrix matrix;
    PatchField<double> areas{std::vector<double>(40)};

    Noisy()
    {
        std::mt19937 generator(7);
        std::uniform_real_distribution<double> uniform(0, 1);
        const auto random = [&] { return uniform(generator); };
        for (double& area : areas.values()) area = 0.2 + random();
        double total = 0;
        for (const double area : areas.values()) total += area;
        std::vector<std::vector<std::pair<std::uint32_t, double>>> rows(areas.size());
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = rows.size(); j-- > 0;)
                if (i != j && (i + j) % 7 != 0 && random() < 0.8)
                    rows[i].emplace_back(j, areas[PatchId(j)] / total * (0.7 + 0.6 * random()));
        matrix = matrix_of(rows);
    }
};

TEST(Repair, GivesReciprocityAndClosure)
{
    Noisy noisy;
    const FormFactorMatrix before = noisy.matrix;
    const RepairReport report = repair_symmetrically(noisy.matrix, noisy.areas, true);
    const FormFactorAudit after = audit(noisy.matrix, noisy.areas, true);
    EXPECT_TRUE(report.converged);
    EXPECT_GT(report.closure_before.worst, 0.05);
    EXPECT_GT(report.reciprocity_before.worst, 0.005);
    EXPECT_LT(after.closure.worst, 1e-10);
    EXPECT_LT(after.reciprocity.worst, 1e-15);
    EXPECT_EQ(report.closure_after.worst, after.closure.worst);
    EXPECT_GT(report.iterations, 0U);
    EXPECT_GT(report.largest_row_change, 0);
    std::size_t added = 0;
    for (std::size_t i = 0; i < noisy.matrix.size(); ++i) {
        for (std::size_t k = noisy.matrix.row_start[i]; k < noisy.matrix.row_start[i + 1]; ++k) {
            const std::uint32_t j = noisy.matrix.columns[k];
            EXPECT_GE(noisy.matrix.factors[k], 0);
            EXPECT_TRUE(entry(before, i, j) > 0 || entry(before, j, static_cast<std::uint32_t>(i)) > 0)
                << "0 both ways stays 0";
            if (entry(before, i, j) == 0) ++added;
        }
    }
    EXPECT_GT(added, 0U);
    EXPECT_EQ(report.added, added);
}

TEST(Repair, LeavesWhatIsRightAlone)
{
    Box box;
    const FormFactorMatrix before = box.matrix;
    const RepairReport report = repair_symmetrically(box.matrix, box.areas, true);
    EXPECT_EQ(box.matrix.columns, before.columns);
    for (std::size_t k = 0; k < before.factors.size(); ++k)
        EXPECT_NEAR(box.matrix.factors[k], before.factors[k], 1e-15);
    EXPECT_LT(report.largest_row_change, 1e-15);
    EXPECT_EQ(report.added, 0U);
}

TEST(Repair, BacksStayOutOfTheRowsSum)
{
    Noisy noisy;
    noisy.matrix.backs = PatchField<double>(40, 0.25);
    repair_symmetrically(noisy.matrix, noisy.areas, true);
    double sum = 0;
    for (std::size_t k = noisy.matrix.row_start[3]; k < noisy.matrix.row_start[4]; ++k) sum += noisy.matrix.factors[k];
    EXPECT_NEAR(sum, 0.75, 1e-11);
}

TEST(Repair, InAnOpenSceneWhatEscapesIsScaledAlong)
{
    for (const bool known : {true, false}) {
        Noisy noisy;
        if (known) {
            noisy.matrix.escaped = PatchField<double>(40);
            for (std::size_t i = 0; i < 40; ++i) noisy.matrix.escaped[PatchId(i)] = i % 2 == 0 ? 0.3 : 0.05;
        }
        const RepairReport report = repair_symmetrically(noisy.matrix, noisy.areas, false);
        EXPECT_TRUE(report.converged);
        const FormFactorAudit after = audit(noisy.matrix, noisy.areas, false);
        EXPECT_LT(after.reciprocity.worst, 1e-15);
        EXPECT_LT(after.closure.worst, 1e-11);
        for (const double escaped : noisy.matrix.escaped.values()) EXPECT_TRUE(escaped >= 0 && escaped < 1);
    }
}

TEST(Repair, AReciprocalMatrixOfAnOpenSceneStaysWhatItIs)
{
    const double there = 0.19982489569838738304;
    FormFactorMatrix matrix = matrix_of({{{1, there}}, {{0, there}}});
    const RepairReport report = repair_symmetrically(matrix, PatchField<double>(2, 1.0), false);
    EXPECT_NEAR(matrix.factors[0], there, 1e-15);
    EXPECT_NEAR(matrix.escaped[PatchId(0UL)], 1 - there, 1e-15);
    EXPECT_LE(report.iterations, 1U);
}

TEST(Repair, WhatCannotBeScaledIsSaid)
{
    // The middle one alone can take what both others send: no scaling makes all three sums 1.
    FormFactorMatrix matrix = matrix_of({{{1, 1}}, {{0, 0.5}, {2, 0.5}}, {{1, 1}}});
    const RepairReport report = repair_symmetrically(matrix, PatchField<double>(3, 1.0), true);
    EXPECT_FALSE(report.converged);
    EXPECT_GT(report.closure_after.worst, 0.1);
    for (const double factor : matrix.factors) EXPECT_TRUE(factor >= 0 && factor <= 1);
    FormFactorMatrix negative = matrix_of({{{1, -0.1}}, {}});
    EXPECT_THROW(repair_symmetrically(negative, PatchField<double>(2, 1.0), true), std::invalid_argument);
}

// Found by fuzzing: one scale grew and the other shrank until their product was no number, or 0 and so converged.
TEST(Repair, ScalesThatGrowWithoutEndLeaveNumbers)
{
    for (const double area : {100.0, 1e9}) {
        FormFactorMatrix matrix = matrix_of({{{1, 1}}, {{0, 0.5}, {2, 0.5}}, {{1, 1}}});
        const RepairReport report =
            repair_symmetrically(matrix, PatchField<double>(std::vector<double>{area, 1, area}), true);
        EXPECT_FALSE(report.converged);
        for (const double factor : matrix.factors) EXPECT_TRUE(factor > 0 && std::isfinite(factor)) << factor;
    }
}

TEST(Repair, ARowWithoutFactorsStaysWithout)
{
    FormFactorMatrix matrix = matrix_of({{{1, 0.9}}, {{0, 0.9}}, {}});
    matrix.backs = PatchField<double>(std::vector<double>{0, 0, 1});
    const RepairReport report = repair_symmetrically(matrix, PatchField<double>(3, 1.0), true);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(matrix.row_start, (std::vector<std::size_t>{0, 1, 2, 2}));
    EXPECT_NEAR(entry(matrix, 0, 1), 1, 1e-12);
}

}  // namespace
}  // namespace patchlight::testing
