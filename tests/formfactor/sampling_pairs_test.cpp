#include "formfactor/pair_factor.h"
#include "tests/formfactor/pairs.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace patchlight {
namespace {

using testing::KnownPair;
using testing::PairScene;

struct Method {
    std::string name;
    std::function<PairFactor(const PairScene&, const PairOptions&)> factor;
};

const Method hemicube{"hemicube", [](const PairScene& p, const PairOptions& options) {
                          return pair_by_hemicube(p.scene, p.from, p.to, options);
                      }};
const Method hemisphere{"hemisphere", [](const PairScene& p, const PairOptions& options) {
                            return pair_by_hemisphere(p.scene, p.caster, p.from, p.to, options);
                        }};
const Method monte_carlo{"monte-carlo", [](const PairScene& p, const PairOptions& options) {
                             return pair_by_monte_carlo(p.scene, p.caster, p.from, p.to, options);
                         }};

/// The root mean square of the error over seeds, and the mean of what the method says it is.
struct Spread {
    double error = 0, reported = 0;
};

Spread spread(const Method& method, const KnownPair& pair, PairOptions options, int seeds)
{
    const PairScene scene(pair);
    Spread result;
    for (int seed = 1; seed <= seeds; ++seed) {
        options.seed = static_cast<std::uint64_t>(seed);
        const PairFactor factor = method.factor(scene, options);
        result.error += (factor.value - pair.factor) * (factor.value - pair.factor) / seeds;
        result.reported += factor.error / seeds;
    }
    result.error = std::sqrt(result.error);
    return result;
}

void expect_within(const Method& method, const KnownPair& pair, double relative)
{
    const PairScene scene(pair);
    const PairFactor factor = method.factor(scene, {});
    EXPECT_NEAR(factor.value, pair.factor, relative * pair.factor) << method.name << ", " << pair.name;
    EXPECT_GT(factor.error, 0) << method.name << ", " << pair.name;
    EXPECT_LT(factor.error, relative * pair.factor) << method.name << ", " << pair.name;
    EXPECT_GT(factor.samples, 0U);
}

// The bounds a user is promised; measured root mean square errors over seeds are 0.01–0.1 % (0.7 % for the far pair
// by rays, of which 0.3 % arrive), so that no seed comes near them.
TEST(SamplingPairs, TheDefaultsMeetTheClosedForms)
{
    for (const Method& method : {hemicube, hemisphere}) {
        for (const KnownPair& pair : testing::facing_pairs()) expect_within(method, pair, 0.005);
        for (const KnownPair& pair : testing::hinged_pairs()) expect_within(method, pair, 0.015);
        expect_within(method, testing::far_pair(), 0.02);
        for (const KnownPair& pair : testing::blocked_pairs()) expect_within(method, pair, 0.01);
    }
}

// The distribution is normal to a part in 10⁴ after 2^16 pairs: 4 standard errors leave 1 in 16,000.
TEST(SamplingPairs, MonteCarloIsWithinFourStandardErrorsOfAllKnownPairs)
{
    std::vector<KnownPair> pairs = testing::facing_pairs();
    for (const auto& more : {testing::hinged_pairs(), testing::blocked_pairs(), {testing::far_pair()}})
        pairs.insert(pairs.end(), more.begin(), more.end());
    for (const KnownPair& pair : pairs) {
        const PairScene scene(pair);
        const PairFactor factor = monte_carlo.factor(scene, {});
        EXPECT_NEAR(factor.value, pair.factor, 4 * factor.error) << pair.name;
        EXPECT_LE(factor.error, 0.005 * factor.value) << pair.name;
    }
}

// 2.5 standard errors hold 98.8 %; fewer than 45 of 50 would come once in 10⁵.
TEST(SamplingPairs, MonteCarlosIntervalHoldsTheTruth)
{
    for (const KnownPair& pair :
         {testing::facing_pairs()[2], testing::hinged_pairs()[3], testing::blocked_pairs()[1], testing::far_pair()}) {
        const PairScene scene(pair);
        int held = 0;
        for (std::uint64_t seed = 1; seed <= 50; ++seed) {
            const PairFactor factor = monte_carlo.factor(scene, {.seed = seed});
            held += std::abs(factor.value - pair.factor) <= 2.5 * factor.error ? 1 : 0;
        }
        EXPECT_GE(held, 45) << pair.name;
    }
}

// A tighter demand takes more samples: n grows with the inverse square, and the error keeps to what is asked.
TEST(SamplingPairs, MonteCarloGoesOnUntilItsErrorIsSmall)
{
    const PairScene scene(testing::hinged_pairs()[0]);
    const PairFactor rough = monte_carlo.factor(scene, {.relative_error = 0.01});
    const PairFactor fine = monte_carlo.factor(scene, {.relative_error = 0.001});
    EXPECT_LE(fine.error, 0.001 * fine.value);
    EXPECT_GT(fine.samples, 8 * rough.samples);
}

// Strata of n origins leave n^-1/2 at worst (0.5 for four times as many), less where the integrand is smooth; 0.7
// allows for the scatter of a root mean square over 40 seeds (11 %).
TEST(SamplingPairs, ErrorsFallWithOriginsAndRays)
{
    for (const KnownPair& pair :
         {testing::facing_pairs()[2], testing::hinged_pairs()[0], testing::blocked_pairs()[0]}) {
        double cubes = 1e9, rays = 1e9;
        for (int k = 0; k < 3; ++k) {
            const int times = 1 << (2 * k);
            const double by_cubes = spread(hemicube, pair, {.origins = 16 * times, .resolution = 64}, 40).error;
            const double by_rays = spread(hemisphere, pair, {.rays = std::size_t{1} << (12 + 2 * k)}, 40).error;
            EXPECT_LE(by_cubes, 0.7 * cubes) << pair.name << ", " << 16 * times << " hemicubes";
            EXPECT_LE(by_rays, 0.7 * rays) << pair.name << ", " << times << " times the rays";
            cubes = by_cubes;
            rays = by_rays;
        }
    }
}

// Of one set of origins and turns, so that only the pixels' error is left (the finest's own is 1/20 of the rest).
// Pixels on an outline of r of them err by chance, r^-3/2 in all: 0.35 for twice the resolution, 0.7 with scatter.
TEST(SamplingPairs, ErrorsFallWithTheResolution)
{
    const PairScene scene(testing::blocked_pairs()[0]);
    std::array<double, 3> squares{};
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        PairOptions options{.origins = 16, .resolution = 512, .seed = seed};
        const double finest = hemicube.factor(scene, options).value;
        for (std::size_t k = 0; k < squares.size(); ++k) {
            options.resolution = 16 << k;
            const double e = hemicube.factor(scene, options).value - finest;
            squares[k] += e * e;
        }
    }
    EXPECT_LE(std::sqrt(squares[1]), 0.7 * std::sqrt(squares[0]));
    EXPECT_LE(std::sqrt(squares[2]), 0.7 * std::sqrt(squares[1]));
}

// 16 groups give a standard error to 18 %, 40 seeds a root mean square to 11 %: a factor of two is four deviations.
// The hemicube at a resolution where the raster, whose error all groups share, is out of the way.
TEST(SamplingPairs, TheReportedErrorIsTheError)
{
    for (const KnownPair& pair : {testing::facing_pairs()[2], testing::hinged_pairs()[0], testing::blocked_pairs()[1]})
        for (const Method& method : {hemicube, hemisphere}) {
            const PairOptions options{.origins = 128, .resolution = 256, .rays = 1 << 16};
            const Spread s = spread(method, pair, options, 40);
            EXPECT_LT(s.error, 2 * s.reported) << method.name << ", " << pair.name;
            EXPECT_GT(s.error, 0.5 * s.reported) << method.name << ", " << pair.name;
        }
}

TEST(SamplingPairs, WhatCannotSeeEachOtherExchangesNothing)
{
    const testing::Corners floor = testing::floor_of(1, 1);
    const testing::Corners beside{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
    for (const testing::Corners& to : {beside, testing::ceiling_of(1, 1, -1), testing::floor_of(1, 1, 1)}) {
        const PairScene scene({"unseen", floor, to, {}, 0});
        for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
            const PairFactor factor = method.factor(scene, {.origins = 64, .rays = 1 << 14});
            EXPECT_EQ(factor.value, 0) << method.name;
            EXPECT_EQ(factor.error, 0) << method.name;
        }
    }
}

// Nothing found in 2^22 rays: the factor is below 3/2^22 with a confidence of 95 %.
TEST(SamplingPairs, MonteCarloBoundsWhatItDidNotSee)
{
    const PairScene scene({"a wall between",
                           testing::floor_of(1, 1),
                           testing::ceiling_of(1, 1, 1),
                           {{{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}}},
                           0});
    const PairFactor factor = monte_carlo.factor(scene, {});
    EXPECT_EQ(factor.value, 0);
    EXPECT_GT(factor.error, 0);
    EXPECT_LE(factor.error, 3.0 / (1 << 22));
}

TEST(SamplingPairs, ThreadsDoNotChangeABit)
{
    const PairScene scene(testing::blocked_pairs()[1]);
    for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
        const PairOptions options{.origins = 100, .rays = 1 << 17, .seed = 7};
        const PairFactor many = method.factor(scene, options);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const PairFactor alone = method.factor(scene, options);
        EXPECT_EQ(many.value, alone.value) << method.name;
        EXPECT_EQ(many.error, alone.error) << method.name;
        EXPECT_EQ(many.samples, alone.samples) << method.name;
    }
}

TEST(SamplingPairs, SeedsAreIndependent)
{
    const PairScene scene(testing::facing_pairs()[2]);
    for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
        const PairOptions first{.origins = 64, .rays = 1 << 14, .seed = 1},
            second{.origins = 64, .rays = 1 << 14, .seed = 2};
        EXPECT_NE(method.factor(scene, first).value, method.factor(scene, second).value) << method.name;
    }
}

/// The floor in two parts of different size and shape, as `from`; the ceiling in two triangles, as `to`.
PairScene in_parts()
{
    PairScene parts(
        {"in parts", {{0, 0, 0}, {0.3, 0, 0}, {0.3, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}}, {}, 0});
    testing::add_surface(parts.scene, {{0.3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.3, 1, 0}}, 0);
    testing::add_surface(parts.scene, {{0, 0, 1}, {1, 1, 1}, {1, 0, 1}}, 0);
    parts.caster = RayCaster(parts.scene);
    for (const Facet& facet : facets_of(parts.scene, SurfaceId(std::size_t{2}))) parts.from.push_back(facet);
    for (const Facet& facet : facets_of(parts.scene, SurfaceId(std::size_t{3}))) parts.to.push_back(facet);
    return parts;
}

// The parts' union is the whole's; bounds as in TheDefaultsMeetTheClosedForms.
TEST(SamplingPairs, PartsCountByTheirAreas)
{
    const PairScene parts = in_parts();
    const double whole = testing::facing_pairs()[2].factor;
    for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
        const PairFactor factor = method.factor(parts, {});
        EXPECT_NEAR(factor.value, whole, std::max(0.005 * whole, 4 * factor.error)) << method.name;
    }
}

// One triangle may be two surfaces, one a side.
TEST(SamplingPairs, BothSidesOfATwoSidedPolygonAreToldApart)
{
    PairScene pair({"two-sided", testing::floor_of(1, 1), testing::floor_of(1, 1, 1), {}, 0});
    Surface below = pair.scene.surfaces[1];
    std::swap(below.frame.u, below.frame.v);
    below.frame.n = -below.frame.n;
    std::reverse(below.loops[0].begin(), below.loops[0].end());
    for (SceneTriangle& t : pair.scene.triangles)
        if (t.front.value == 1) t.back = SurfaceId(std::size_t{2});
    pair.scene.surfaces.push_back(below);
    pair.caster = RayCaster(pair.scene);
    const double truth = testing::facing_pairs()[2].factor;
    for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
        EXPECT_EQ(method.factor(pair, {.origins = 64, .rays = 1 << 14}).value, 0) << method.name << ": the far side";
    }
    pair.to = facets_of(pair.scene, SurfaceId(std::size_t{2}));
    for (const Method& method : {hemicube, hemisphere, monte_carlo}) {
        const PairFactor factor = method.factor(pair, {});
        EXPECT_NEAR(factor.value, truth, std::max(0.005 * truth, 4 * factor.error)) << method.name << ": the near side";
    }
}

TEST(SamplingPairs, SidesWithoutAreaAreRefused)
{
    const PairScene pair(testing::facing_pairs()[2]);
    EXPECT_THROW(pair_by_hemicube(pair.scene, {}, pair.to, {}), std::invalid_argument);
    EXPECT_THROW(pair_by_hemisphere(pair.scene, pair.caster, {}, pair.to, {}), std::invalid_argument);
    EXPECT_THROW(pair_by_monte_carlo(pair.scene, pair.caster, pair.from, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace patchlight
