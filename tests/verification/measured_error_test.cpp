// Errors measured through noise: made-up points whose true error is known.
#include "apps/verification/measured_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace patchlight {
namespace {

/// Lights of many sizes; a solution that is `off` by a share of each; values found with a relative noise of each, whose
/// variance is estimated from `streams` repetitions.
std::vector<MeasuredPoint> made_up(std::size_t n, double off, double noise, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    constexpr int streams = 8;
    std::vector<MeasuredPoint> points(n);
    for (std::size_t i = 0; i < n; ++i) {
        MeasuredPoint& p = points[i];
        p.surface = SurfaceId(i % 3);
        const double sign = i % 2 == 0 ? 1 : -1;
        for (int band = 0; band < 3; ++band) {
            const double B = std::exp(0.5 * normal(random)), sigma = noise * B * std::sqrt(double(streams));
            p.shown[band] = (1 + sign * off) * B;
            double sum = 0, squares = 0;
            for (int k = 0; k < streams; ++k) {
                const double x = B + sigma * normal(random);
                sum += x;
                squares += x * x;
            }
            p.found[band] = sum / streams;
            p.variance[band] = (squares - sum * sum / streams) / (streams * (streams - 1));
        }
    }
    return points;
}

TEST(MeasuredError, IsTheErrorAndNotTheNoise)
{
    // All points are off by 2 % exactly. Noise of 5 % alone would look like an error of 5 %.
    const MeasuredError clean = measured_error(made_up(2000, 0.02, 0, 1), 1);
    EXPECT_NEAR(clean.l2, 0.02, 1e-12);
    EXPECT_NEAR(clean.relrms, 0.02, 1e-12);
    EXPECT_EQ(clean.relrms_values, 6000U);
    const MeasuredError noisy = measured_error(made_up(2000, 0.02, 0.05, 1), 1);
    // Σ of 6,000 squares: d² is known to √2 · 5 %² / √6000 = 4.6e-5, a ninth of .02²; √ halves that, weights double it.
    EXPECT_NEAR(noisy.l2, 0.02, 0.006);
    EXPECT_NEAR(noisy.l2_noise, 0.05, 0.005);
    EXPECT_NEAR(noisy.relrms_noise, 0.05, 0.005);
    EXPECT_GT(noisy.from_paths, 0.9) << "all points are off by the same share: only the noise scatters";
}

TEST(MeasuredError, IntervalsHoldTheTruthAsOftenAsTheySay)
{
    int l2 = 0, relrms = 0;
    constexpr int runs = 300;
    for (int k = 0; k < runs; ++k) {
        const MeasuredError error = measured_error(made_up(400, 0.02, 0.02, 100 + k), k);
        l2 += error.l2_ci.low <= 0.02 && 0.02 <= error.l2_ci.high ? 1 : 0;
        relrms += error.relrms_ci.low <= 0.02 && 0.02 <= error.relrms_ci.high ? 1 : 0;
    }
    // 95 % of 300 ± 3.4 standard deviations: 272 to 298. Percentiles of so few points of uneven light hold a little
    // less.
    EXPECT_GE(l2, 267);
    EXPECT_GE(relrms, 267);
    EXPECT_LE(l2, 299);
}

TEST(MeasuredError, WithoutErrorTheIntervalReachesZero)
{
    int reach = 0;
    for (int k = 0; k < 100; ++k) reach += measured_error(made_up(400, 0, 0.03, 500 + k), k).l2_ci.low == 0 ? 1 : 0;
    EXPECT_GE(reach, 90) << "97.5 of 100, less three standard deviations and a little for the percentiles";
}

TEST(MeasuredError, NothingOverNothingIsNothing)
{
    EXPECT_EQ(measured_error({}, 1).l2, 0);
    const std::vector<MeasuredPoint> dark(10);
    const MeasuredError none = measured_error(dark, 1);
    EXPECT_EQ(none.l2, 0);
    EXPECT_EQ(none.l2_ci.high, 0);
    EXPECT_EQ(none.relrms, 0);
    std::vector<MeasuredPoint> ghost(10);
    for (MeasuredPoint& p : ghost) p.shown = Rgb(1.0);
    EXPECT_EQ(measured_error(ghost, 1).l2, std::numeric_limits<double>::infinity()) << "light where there is none";
}

TEST(MeasuredError, DimPointsDoNotCountRelatively)
{
    auto points = made_up(1000, 0.02, 0, 1);
    points.push_back({SurfaceId(0), Rgb(1e-3), 0, Rgb(1e-5), Rgb(0.0)});
    const MeasuredError error = measured_error(points, 1);
    EXPECT_EQ(error.relrms_values, 3000U);
    EXPECT_NEAR(error.relrms, 0.02, 1e-12);
    EXPECT_NEAR(error.l2, 0.02, 1e-6) << "in L2 they count, for what they are";
}

TEST(ErrorsBySurface, AddUpToTheWhole)
{
    const auto points = made_up(999, 0.02, 0.01, 2);
    double share = 0;
    const auto errors = errors_by_surface(points);
    ASSERT_EQ(errors.size(), 3U);
    for (const SurfaceError& e : errors) {
        share += e.share;
        EXPECT_EQ(e.points, 333U);
        EXPECT_NEAR(e.l2, 0.02, 0.003);
    }
    EXPECT_NEAR(share, 1, 1e-12);
}

TEST(PointShares, DecideOnlyWhatTheNoiseLetsThem)
{
    const auto at = [](double error, double sigma) {
        return MeasuredPoint{SurfaceId(0), {1 + error, 0, 0}, 0, {1, 0, 0}, {sigma * sigma, 0, 0}};
    };
    const std::vector<MeasuredPoint> points{at(0.05, 0.01), at(0.2, 0.01), at(0.09, 0.01), at(-0.11, 0.01)};
    const PointShares shares = shares_within(points, [](const MeasuredPoint&) { return 0.1; });
    EXPECT_EQ(shares.within, 0.25);
    EXPECT_EQ(shares.beyond, 0.25);
    EXPECT_EQ(shares.undecided, 0.5);
}

TEST(EstimateCheck, SaysOnlyWhatTheIntervalAllows)
{
    MeasuredError measured;
    measured.l2 = 0.01;
    measured.l2_ci = {0.009, 0.012};
    EXPECT_EQ(check_estimate(0.012, measured).verdict, Verdict::holds);
    EXPECT_NEAR(check_estimate(0.012, measured).effectivity, 1.2, 1e-12);
    EXPECT_NEAR(check_estimate(0.012, measured).range.low, 1, 1e-12);
    EXPECT_EQ(check_estimate(0.004, measured).verdict, Verdict::too_small);
    EXPECT_EQ(check_estimate(0.04, measured).verdict, Verdict::too_large);
    EXPECT_EQ(check_estimate(0.005, measured).verdict, Verdict::undecided) << "between .42 and .56 of it";
    EXPECT_EQ(check_estimate(0.03, measured).verdict, Verdict::undecided) << "between 2.5 and 3.3 times it";
    const MeasuredError none;
    EXPECT_EQ(check_estimate(0, none).verdict, Verdict::holds);
    EXPECT_EQ(check_estimate(0, none).effectivity, 1);
    EXPECT_EQ(check_estimate(0.01, none).verdict, Verdict::too_large);
}

}  // namespace
}  // namespace patchlight
