// What a view makes of a patch: the dual solution against closed forms, and against the light itself.
#include "solver/importance.h"

#include "tests/solver/linear_systems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace patchlight {
namespace {

using testing::cornell_system;
using testing::cube_system;
using testing::eliminated;

const SolveOptions tight{.tolerance = 1e-10};

/// A few patches of a floor's corner, one of them three times, and one ray that met nothing.
std::vector<PatchId> some_patches()
{
    return {PatchId(0UL), PatchId(1UL), PatchId(1UL), PatchId(1UL), PatchId(13UL), PatchId()};
}

/// Σ seen B against Σ A Y E, band by band.
std::pair<Rgb, Rgb> both_ways(const RadiositySystem& system, const PatchField<double>& seen)
{
    const Radiosity B = eliminated(system);
    const Importance Y = importance(system, rows_of(system.F), seen, tight);
    Rgb light(0.0), dual(0.0);
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        light += seen[p] * B[p];
        dual += system.area[p] * Y.density[p] * system.E[p];
    }
    return {light, dual};
}

TEST(Importance, SharesAreOfWhatIsSeen)
{
    const PatchField<double> seen = seen_shares(20, some_patches());
    EXPECT_DOUBLE_EQ(seen[PatchId(0UL)], 0.2);
    EXPECT_DOUBLE_EQ(seen[PatchId(1UL)], 0.6);
    EXPECT_DOUBLE_EQ(seen[PatchId(13UL)], 0.2);
    EXPECT_DOUBLE_EQ(std::reduce(seen.values().begin(), seen.values().end()), 1);
}

// ⟨seen, B⟩ = ⟨A Y, E⟩, to the dual's tolerance.
TEST(Importance, BringsTheSameNumberAsTheLight)
{
    RadiositySystem system = cube_system(0.8);
    for (std::size_t i = 100; i < 200; ++i) system.rho[PatchId(i)] = Rgb(0, .4, .9);
    const auto [light, dual] = both_ways(system, seen_shares(system.area.size(), some_patches()));
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(dual[band] / light[band], 1, 1e-8);
}

/// The dual's number over the light's in the Cornell box, where its first 100 patches are seen.
Rgb ratio_in_the_box(const FormFactorOptions& options)
{
    std::vector<PatchId> seen;
    for (std::size_t i = 0; i < 100; ++i) seen.emplace_back(i);
    const RadiositySystem system = cornell_system(options, 500);
    const auto [light, dual] = both_ways(system, seen_shares(system.area.size(), seen));
    return dual / light;
}

TEST(Importance, BringsTheSameNumberByExactFactorsWithBlockers)
{
    const Rgb ratio = ratio_in_the_box({.method = FormFactorMethod::exact});
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(ratio[band], 1, 1e-8);
}

// Sampled rows and their dual are two estimates: the ratio varies by .04 from seed to seed (standard deviation over
// twelve), so that the mean of eight must be within three times .04/√8.
TEST(Importance, BringsTheSameNumberBySampledRowsOnAverage)
{
    constexpr std::uint64_t seeds = 8;
    Rgb mean(0.0);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        mean += ratio_in_the_box({.rays = 512, .seed = seed}) / static_cast<double>(seeds);
    for (int band = 0; band < 3; ++band) EXPECT_NEAR(mean[band], 1, 3 * 0.04 / std::sqrt(8.0));
}

// In a furnace E = 1 makes B = 1/(1 − ρ) everywhere: Σ A Y = 1/(1 − ρ), whatever is seen.
TEST(Importance, SumsToTheFurnace)
{
    for (const double rho : {0.0, 0.5, 0.9}) {
        const RadiositySystem system = cube_system(rho);
        const Importance Y =
            importance(system, rows_of(system.F), seen_shares(system.area.size(), some_patches()), tight);
        double sum = 0;
        for (std::size_t i = 0; i < system.area.size(); ++i) sum += system.area[PatchId(i)] * Y.density[PatchId(i)].g;
        EXPECT_NEAR(sum * (1 - rho), 1, 1e-8) << rho;
        EXPECT_TRUE(Y.solved.converged);
    }
}

// Inside of a sphere F_ij = A_j/A: Y_i = seen_i/A_i + Σ ρ seen/(1 − mean ρ)/A.
TEST(Importance, IsTheClosedFormInASphere)
{
    constexpr std::size_t n = 1000;
    RadiositySystem system;
    system.area = PatchField<double>(n);
    system.rho = PatchField<Rgb>(n);
    PatchField<double> seen(n, 0.0);
    seen[PatchId(3UL)] = 0.25;
    seen[PatchId(4UL)] = 0.75;
    double area = 0;
    Rgb mean_rho(0.0), seen_rho(0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const PatchId p(i);
        system.area[p] = 1 + static_cast<double>(i % 7);
        system.rho[p] = Rgb(0, 0.1 * static_cast<double>(i % 9), 0.9);
        area += system.area[p];
        mean_rho += system.area[p] * system.rho[p];
        seen_rho += seen[p] * system.rho[p];
    }
    const Rgb elsewhere = seen_rho / (1.0 - mean_rho / area) / area;
    const LightOperator sphere = [&](const Radiosity& B, Radiosity& arrived) {
        Rgb sum(0.0);
        for (std::size_t i = 0; i < n; ++i) sum += system.area[PatchId(i)] * B[PatchId(i)];
        for (std::size_t i = 0; i < n; ++i) arrived[PatchId(i)] = sum / area;
    };
    const Importance Y = importance(system, sphere, seen, tight);
    for (std::size_t i = 0; i < n; ++i)
        for (int band = 0; band < 3; ++band)
            ASSERT_NEAR(Y.density[PatchId(i)][band], seen[PatchId(i)] / system.area[PatchId(i)] + elsewhere[band],
                        1e-8 * (elsewhere[band] + 1 / area));
}

TEST(Importance, WeighsWhatIsSeenMoreAndADarkRoomNextDoorNothing)
{
    // Two patches that see each other, two that see each other, and no light between the pairs.
    RadiositySystem system;
    system.area = PatchField<double>(4, 1.0);
    system.rho = PatchField<Rgb>(4, Rgb(0.5));
    system.E = PatchField<Rgb>(4, Rgb(1.0));
    system.F.row_start = {0, 1, 2, 3, 4};
    system.F.columns = {1, 0, 3, 2};
    system.F.factors = {0.5, 0.5, 0.5, 0.5};
    const std::vector<PatchId> first{PatchId(0UL)};
    const Importance Y = importance(system, rows_of(system.F), seen_shares(4, first), tight);
    // Y_0 = 1 + .25 Y_1, Y_1 = .25 Y_0.
    EXPECT_NEAR(Y.density[PatchId(0UL)].r, 16.0 / 15, 1e-9);
    EXPECT_NEAR(Y.density[PatchId(1UL)].r, 4.0 / 15, 1e-9);
    const PatchField<double> w = importance_weights(system, Y);
    EXPECT_NEAR(w[PatchId(0UL)], 3.2, 1e-8) << "of a mean of 1";
    EXPECT_NEAR(w[PatchId(1UL)], 0.8, 1e-8);
    EXPECT_EQ(w[PatchId(2UL)], 0);
    EXPECT_EQ(w[PatchId(3UL)], 0);

    ErrorEstimate error;
    error.eta = PatchField<double>(4, 1.0);
    error.total = 2;
    const ErrorEstimate scaled = weighted(error, w);
    EXPECT_NEAR(scaled.eta[PatchId(0UL)], std::sqrt(3.2), 1e-8);
    EXPECT_EQ(scaled.eta[PatchId(2UL)], 0);
    EXPECT_EQ(scaled.total, 2);
}

TEST(Importance, NothingSeenLeavesAllAsItIs)
{
    const RadiositySystem system = cube_system(0.5);
    const PatchField<double> seen = seen_shares(system.area.size(), {});
    const Importance Y = importance(system, rows_of(system.F), seen);
    const PatchField<double> weights = importance_weights(system, Y);
    for (const double w : weights.values()) ASSERT_EQ(w, 1);
}

}  // namespace
}  // namespace patchlight
