#include "formfactor/closed_form.h"

#include "formfactor/random_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace patchlight {
namespace {

// A dozen elementary functions, each good to half a unit in the last place.
constexpr double rounding = 2e-15;

// reference-values.md §1.
TEST(ClosedForm, OpposedRectangles)
{
    EXPECT_NEAR(parallel_rectangles(1, 1, 1), 0.19982489569838738304, rounding);
    EXPECT_NEAR(parallel_rectangles(1, 1, 0.1), 0.82699452239725657792, rounding);
    EXPECT_NEAR(parallel_rectangles(1, 1, 0.5), 0.41525328357714673537, rounding);
    EXPECT_NEAR(parallel_rectangles(1, 1, 2), 0.068589588818552447785, rounding);
    EXPECT_NEAR(parallel_rectangles(1, 1, 10), 0.0031620568387576016251, rounding);
    EXPECT_NEAR(parallel_rectangles(2, 1, 1), 0.28587538485071471830, rounding);
    EXPECT_NEAR(parallel_rectangles(3, 2, 1), 0.47557643653295291991, rounding);
}

TEST(ClosedForm, RectanglesThatShareAnEdge)
{
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 1), 0.20004377607540315424, rounding);
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 2), 0.23285260279536188805, rounding);
    EXPECT_NEAR(perpendicular_rectangles(1, 2, 1), 0.11642630139768094403, rounding);
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 0.5), 0.14618667910571331616, rounding);
}

TEST(ClosedForm, CoaxialDiscs)
{
    EXPECT_NEAR(coaxial_discs(1, 1, 1), (3 - std::sqrt(5.0)) / 2, rounding);
    EXPECT_NEAR(coaxial_discs(1, 1, 2), 0.17157287525380990240, rounding);
    EXPECT_NEAR(coaxial_discs(1, 2, 1), 0.76393202250021030359, rounding);
    EXPECT_NEAR(coaxial_discs(2, 1, 1), 0.19098300562505257590, rounding);
}

// The six faces of a box see nothing but each other: every row of F sums to 1.
TEST(ClosedForm, BoxesOfAnyShapeClose)
{
    RandomNumbers random(1, 1);
    for (int i = 0; i < 1000; ++i) {
        const double a = std::pow(10, 4 * random.uniform() - 2), b = std::pow(10, 4 * random.uniform() - 2);
        const double c = std::pow(10, 4 * random.uniform() - 2);
        const double row = parallel_rectangles(a, b, c) + 2 * perpendicular_rectangles(a, b, c) +
                           2 * perpendicular_rectangles(b, a, c);
        // The perpendicular form's terms are up to l/w = 1e4 times the factor.
        EXPECT_NEAR(row, 1, 1e-12) << a << " " << b << " " << c;
    }
}

TEST(ClosedForm, AreasTimesFactorsAreReciprocal)
{
    RandomNumbers random(2, 1);
    for (int i = 0; i < 1000; ++i) {
        const double a = std::pow(10, 4 * random.uniform() - 2), b = std::pow(10, 4 * random.uniform() - 2);
        EXPECT_NEAR(a * perpendicular_rectangles(1, a, b), b * perpendicular_rectangles(1, b, a), 1e-14 * (a + b));
        EXPECT_NEAR(a * a * coaxial_discs(a, b, 1) / (b * b * coaxial_discs(b, a, 1)), 1, 1e-14);
    }
}

// Far apart F = (1 − 2/(3c²))/πc² + …: the closed form's braces have lost all digits there, its integral none.
TEST(ClosedForm, FarRectanglesKeepTheirDigits)
{
    for (const double c : {1e3, 1e5, 1e7}) {
        const double far = 1 / (std::numbers::pi * c * c);
        EXPECT_NEAR(parallel_rectangles(1, 1, c) / far, 1 - 2 / (3 * c * c), 1e-12 + 1 / std::pow(c, 4)) << c;
    }
    // Either side of the change from one to the other: dF/dc ≈ −2F/c, so a relative 1e-10 of c gives 2e-10 of F.
    const double near = parallel_rectangles(1, 1, 4 * (1 - 1e-10)), far = parallel_rectangles(1, 1, 4 * (1 + 1e-10));
    EXPECT_NEAR(near / far, 1, 1e-9);
    EXPECT_GT(near, far);
}

TEST(ClosedForm, LengthsMustBePositive)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, inf}) {
        EXPECT_THROW(parallel_rectangles(bad, 1, 1), std::invalid_argument);
        EXPECT_THROW(parallel_rectangles(1, 1, bad), std::invalid_argument);
        EXPECT_THROW(perpendicular_rectangles(1, bad, 1), std::invalid_argument);
        EXPECT_THROW(coaxial_discs(1, 1, bad), std::invalid_argument);
    }
}

}  // namespace
}  // namespace patchlight
