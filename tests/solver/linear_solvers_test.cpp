// All solvers of one system: they agree with elimination, and take the steps they are known to take.
#include "formfactor/random_numbers.h"
#include "tests/solver/linear_systems.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace patchlight {
namespace {

using testing::cornell_system;
using testing::cube_system;
using testing::eliminated;
using testing::relative_error;

const std::vector<Solver> all_solvers{Solver::progressive, Solver::jacobi, Solver::gauss_seidel,
                                      Solver::conjugate_gradient, Solver::bicgstab};

SolveOptions tight(Solver solver, double tolerance = 1e-9)
{
    return {.solver = solver, .tolerance = tolerance, .max_sweeps = 2000};
}

/// From B = E.
Radiosity solved(const RadiositySystem& system, const SolveOptions& options)
{
    Radiosity B = system.E;
    EXPECT_TRUE(solve(system, B, options).converged) << static_cast<int>(options.solver);
    return B;
}

// The tolerance bounds Σ A|B − B̃| by 1e-9 of Σ A B; the light holds a large part of ΣAB, and L2 weighs single
// patches more: 1e-6 is what is asked, and leaves room for both.
void expect_agreement(const RadiositySystem& system, const std::vector<Solver>& solvers)
{
    const Radiosity exact = eliminated(system);
    for (const Solver solver : solvers)
        EXPECT_LT(relative_error(system, exact, solved(system, tight(solver)), false), 1e-6)
            << static_cast<int>(solver);
}

TEST(LinearSolvers, AgreeOnTheCube)
{
    expect_agreement(cube_system(0.8), all_solvers);
}

TEST(LinearSolvers, AgreeOnTheCornellBoxByExactFactors)
{
    expect_agreement(cornell_system({.method = FormFactorMethod::exact}, 500), all_solvers);
}

// Shooting takes the columns of rows that aren't reciprocal: transposed, the same answer as by gathering.
TEST(LinearSolvers, AgreeOnSampledRows)
{
    const RadiositySystem system = cornell_system({.rays = 128}, 500);
    expect_agreement(system, {Solver::progressive, Solver::jacobi, Solver::gauss_seidel, Solver::bicgstab});
}

TEST(LinearSolvers, ConjugateGradientsRefuseSampledRowsUntilTheyAreReciprocal)
{
    RadiositySystem system = cornell_system({.rays = 128}, 500);
    // Light everywhere, as exact direct light leaves it: a lamp's own rays are few on any one patch.
    system.E = PatchField<Rgb>(system.E.size(), Rgb(1, 2, 3));
    Radiosity B = system.E;
    EXPECT_THROW(solve(system, B, tight(Solver::conjugate_gradient)), std::invalid_argument);
    const Radiosity sampled = eliminated(system);
    make_reciprocal(system, false);
    expect_agreement(system, all_solvers);
    // Both are estimates of one answer from 128 rays a patch, an error of about 1/√128 = 9 % of each B_i.
    EXPECT_LT(relative_error(system, sampled, eliminated(system), false), 0.09);
}

TEST(LinearSolvers, ReciprocalRowsAreLeftAsTheyAre)
{
    RadiositySystem system = cube_system(0.5);
    const std::vector<double> before = system.F.factors;
    make_reciprocal(system, true);
    EXPECT_EQ(before, system.F.factors);
}

/// Sweeps or iterations until the error off the light is below.
int steps_to(const RadiositySystem& system, const Radiosity& exact, Solver solver, double error)
{
    for (int steps = 1; steps < 100; ++steps) {
        Radiosity B = system.E;
        solve(system, B, {.solver = solver, .tolerance = 1e-15, .max_sweeps = steps});
        if (relative_error(system, exact, B) <= error) return steps;
    }
    return 100;
}

// reference-values.md §6: sweeps to 10, 1 and 0.1 %, "indicative": a fifth more or less, and one. Conjugate gradients
// must not take more than the 5 asked for.
TEST(LinearSolvers, TakeTheKnownStepsOnTheCube)
{
    const RadiositySystem system = cube_system(0.8);
    const Radiosity exact = eliminated(system);
    struct Known {
        Solver solver;
        std::array<int, 3> steps;
    };
    for (const auto& [solver, steps] : {Known{Solver::jacobi, {10, 19, 29}}, Known{Solver::gauss_seidel, {6, 10, 15}},
                                        Known{Solver::conjugate_gradient, {3, 4, 5}}}) {
        std::array<int, 3> taken{};
        for (std::size_t k = 0; k < 3; ++k) {
            taken[k] = steps_to(system, exact, solver, std::pow(10.0, -1.0 - static_cast<double>(k)));
            EXPECT_NEAR(taken[k], steps[k], 1 + 0.2 * steps[k]) << static_cast<int>(solver) << ", step " << k;
        }
        std::printf("steps to 10, 1, 0.1 %%: %d %d %d (known %d %d %d)\n", taken[0], taken[1], taken[2], steps[0],
                    steps[1], steps[2]);
        if (solver == Solver::conjugate_gradient) {
            EXPECT_LE(taken[2], 5);
        }
    }
}

/// Gauss–Seidel row by row, as in the books; sweeps until the error is below.
int row_by_row_to(const RadiositySystem& system, const Radiosity& exact, double error)
{
    Radiosity B = system.E;
    LightLanes light(B);
    int sweeps = 0;
    while (relative_error(system, exact, B) > error && ++sweeps < 100)
        for (std::size_t i = 0; i < B.size(); ++i) {
            const PatchId p(i);
            B[p] = system.E[p] + system.rho[p] * gathered(system.F, light, i);
            light.set(p, B[p]);
        }
    return sweeps;
}

// Each sum of a row is kept in four parts, which are added as (0 + 1) + (2 + 3): the very bits, whatever the processor
// has, for rows of every length up to two rounds of sixteen entries and a rest.
TEST(LinearSolvers, RowsAreAddedInTheOrderThatIsPromised)
{
    constexpr std::size_t most = 37;
    Radiosity B(most);
    for (std::size_t i = 0; i < most; ++i) {
        RandomNumbers random(5, i);
        B[PatchId(i)] = Rgb(random.uniform(), 100 * random.uniform(), 1e-3 * random.uniform());
    }
    const LightLanes light(B);
    for (std::size_t count = 0; count <= most; ++count) {
        FormFactorMatrix F;
        F.row_start = {0, count};
        for (std::size_t k = 0; k < count; ++k) {
            F.columns.push_back(static_cast<std::uint32_t>(k * 11 % most));
            F.factors.push_back(1 / (3.0 + static_cast<double>(k)));
        }
        std::array<Rgb, 4> parts{Rgb(0.0), Rgb(0.0), Rgb(0.0), Rgb(0.0)};
        for (std::size_t k = 0; k < count; ++k)
            parts[k < count / 16 * 16 ? k % 4 : 0] += F.factors[k] * B[PatchId(F.columns[k])];
        EXPECT_EQ(gathered(F, light, 0), (parts[0] + parts[1]) + (parts[2] + parts[3])) << count;
    }
}

// Blocks of patches gather at once, for the threads' sake: at most one sweep more, on whole walls as on 16 surfaces.
TEST(LinearSolvers, GaussSeidelInBlocksTakesTheSweepsOfSingleRows)
{
    for (const RadiositySystem& system : {cube_system(0.9), cornell_system({.rays = 128}, 1000)}) {
        const Radiosity exact = eliminated(system);
        for (const double error : {0.1, 0.001, 1e-5})
            EXPECT_LE(steps_to(system, exact, Solver::gauss_seidel, error), row_by_row_to(system, exact, error) + 1);
    }
}

/// Shots until the error off the light is below 10 and 1 %.
std::array<std::size_t, 2> shots_to(const RadiositySystem& system, const Radiosity& exact, const SolveOptions& options)
{
    std::array<std::size_t, 2> shots{0, 0};
    Radiosity B;
    solve_shooting(system, columns_of(system), B, options, {}, [&](const SolveReport& report, const Radiosity& now) {
        const double error = relative_error(system, exact, now);
        if (error > 0.1) shots[0] = report.iterations + 1;
        if (error > 0.01) shots[1] = report.iterations + 1;
    });
    return shots;
}

// §6: 3,760 shots to 10 %, 7,928 to 1 %. Overshooting must need fewer than a half of them.
TEST(LinearSolvers, ShootTheKnownTimesOnTheCube)
{
    const RadiositySystem system = cube_system(0.8);
    const Radiosity exact = eliminated(system);
    SolveOptions options{.solver = Solver::progressive, .tolerance = 1e-3, .max_sweeps = 20};
    const auto plain = shots_to(system, exact, options);
    EXPECT_NEAR(static_cast<double>(plain[0]), 3760, 0.2 * 3760);
    EXPECT_NEAR(static_cast<double>(plain[1]), 7928, 0.2 * 7928);
    options.overshoot = true;
    const auto overshot = shots_to(system, exact, options);
    std::printf("shots to 10, 1 %%: %zu %zu; overshooting %zu %zu\n", plain[0], plain[1], overshot[0], overshot[1]);
    EXPECT_LT(2 * overshot[0], plain[0]);
    EXPECT_LT(2 * overshot[1], plain[1]);
}

TEST(LinearSolvers, OvershootingEndsAtTheSameAnswer)
{
    for (const RadiositySystem& system : {cube_system(0.8), cornell_system({.rays = 128}, 300)}) {
        SolveOptions options = tight(Solver::progressive);
        options.overshoot = true;
        EXPECT_LT(relative_error(system, eliminated(system), solved(system, options)), 1e-6);
    }
}

// Σ A|B − B̃| must lie below what the report says is left, in every band, wherever a solver stops.
TEST(LinearSolvers, TheirBoundHolds)
{
    const RadiositySystem system = cube_system(0.8);
    const Radiosity exact = eliminated(system);
    for (const Solver solver : all_solvers) {
        for (const double tolerance : {0.3, 0.03, 0.003}) {
            Radiosity B = system.E;
            const SolveReport report = solve(system, B, tight(solver, tolerance));
            Rgb error(0.0), total(0.0);
            for (std::size_t i = 0; i < B.size(); ++i) {
                error += system.area[PatchId(i)] * glm::abs(exact[PatchId(i)] - B[PatchId(i)]);
                total += system.area[PatchId(i)] * B[PatchId(i)];
            }
            for (int band = 0; band < 3; ++band)
                EXPECT_LE(error[band] / total[band], report.residual + 1e-12) << static_cast<int>(solver);
            EXPECT_LE(report.residual, tolerance);
            ASSERT_FALSE(report.history.empty());
            EXPECT_EQ(report.history.back(), report.residual);
        }
    }
}

// The answer of the mesh before, prolonged, is near: fewer steps from there than from E; and no start spoils the end.
TEST(LinearSolvers, StartWhereTheyAreTold)
{
    const RadiositySystem system = cube_system(0.8);
    const Radiosity exact = eliminated(system);
    for (const Solver solver : all_solvers) {
        if (solver == Solver::progressive) continue;  // always from E
        Radiosity cold = system.E, warm = exact, wrong(exact.size(), Rgb(1000, 0, 3));
        for (std::size_t i = 0; i < warm.size(); ++i) warm[PatchId(i)] *= i % 2 == 0 ? 1.01 : 0.99;
        const SolveOptions options = tight(solver, 1e-4);
        EXPECT_LT(solve(system, warm, options).iterations, solve(system, cold, options).iterations);
        solve(system, wrong, tight(solver));
        EXPECT_LT(relative_error(system, exact, wrong), 1e-6) << static_cast<int>(solver);
        Radiosity dark(exact.size(), Rgb(0.0));
        solve(system, dark, tight(solver));
        EXPECT_LT(relative_error(system, exact, dark), 1e-6) << static_cast<int>(solver);
    }
}

// Walls that reflect nothing in one band or in any, a lamp that emits none of it, and a high reflectance.
TEST(LinearSolvers, AgreeWithBlackPatchesAndBands)
{
    for (const double rho : {0.3, 0.95}) {
        RadiositySystem system = cube_system(rho);
        for (std::size_t i = 0; i < system.rho.size(); ++i) {
            const PatchId p(i);
            if (i < 144) system.rho[p] = Rgb(0.0);                    // the floor
            if (i >= 300 && i < 500) system.rho[p] = Rgb(rho, 0, 0);  // red walls
            system.E[p].b = 0;                                        // no blue light
            if (system.E[p] != Rgb(0.0)) system.rho[p] = Rgb(0.0);
        }
        expect_agreement(system, all_solvers);
        for (const Solver solver : all_solvers) {
            const Radiosity B = solved(system, tight(solver));
            for (std::size_t i = 0; i < B.size(); ++i) {
                ASSERT_EQ(B[PatchId(i)].b, 0) << static_cast<int>(solver);
                if (i < 144) {
                    ASSERT_EQ(B[PatchId(i)], Rgb(0.0)) << static_cast<int>(solver);
                }
            }
        }
    }
}

TEST(LinearSolvers, NoLightIsSolvedAtOnce)
{
    RadiositySystem system = cube_system(0.8);
    system.E = PatchField<Rgb>(system.E.size(), Rgb(0.0));
    for (const Solver solver : all_solvers) {
        Radiosity B = system.E;
        const SolveReport report = solve(system, B, tight(solver));
        EXPECT_TRUE(report.converged);
        EXPECT_LE(report.iterations, 1U);
        EXPECT_EQ(B, system.E);
    }
}

TEST(LinearSolvers, AllBlackIsTheEmission)
{
    const RadiositySystem system = cube_system(0);
    for (const Solver solver : all_solvers) EXPECT_EQ(solved(system, tight(solver)), system.E);
}

/// Two cubes that don't see each other, side by side in one system; the second has no light.
RadiositySystem two_rooms()
{
    const RadiositySystem one = cube_system(0.8);
    const std::size_t n = one.area.size();
    RadiositySystem both = one;
    const auto twice = [n](const auto& field) {
        auto result = std::remove_cvref_t<decltype(field)>(2 * n);
        for (std::size_t i = 0; i < 2 * n; ++i) result[PatchId(i)] = field[PatchId(i % n)];
        return result;
    };
    both.area = twice(one.area);
    both.rho = twice(one.rho);
    both.E = twice(one.E);
    both.F.raw_sum = both.F.escaped = both.F.backs = PatchField<double>(2 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        both.E[PatchId(n + i)] = Rgb(0.0);
        for (std::size_t k = one.F.row_start[i]; k < one.F.row_start[i + 1]; ++k) {
            both.F.columns.push_back(one.F.columns[k] + static_cast<std::uint32_t>(n));
            both.F.factors.push_back(one.F.factors[k]);
        }
        both.F.row_start.push_back(both.F.columns.size());
    }
    return both;
}

TEST(LinearSolvers, ADarkRoomNextDoorStaysExactlyDark)
{
    const RadiositySystem both = two_rooms();
    const Radiosity exact = eliminated(cube_system(0.8));
    for (const Solver solver : all_solvers) {
        const Radiosity B = solved(both, tight(solver));
        double worst = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            worst = std::max(worst, std::abs(B[PatchId(i)].r / exact[PatchId(i)].r - 1));
            ASSERT_EQ(B[PatchId(exact.size() + i)], Rgb(0.0));
        }
        EXPECT_LT(worst, 1e-6);
    }
}

TEST(LinearSolvers, OnePatchThatSeesNothing)
{
    RadiositySystem system;
    system.area = PatchField<double>(1, 2.0);
    system.E = PatchField<Rgb>(1, Rgb(1, 2, 3));
    system.rho = PatchField<Rgb>(1, Rgb(0.5));
    system.F.row_start = {0, 0};
    for (const Solver solver : all_solvers) EXPECT_EQ(solved(system, tight(solver)), system.E);
}

/// A full symmetric matrix with rows that sum to about 1, large enough for threads in every block.
RadiositySystem large_system()
{
    constexpr std::size_t n = 2000;
    RadiositySystem system;
    system.area = PatchField<double>(n, 1.0);
    system.rho = PatchField<Rgb>(n, Rgb(.3, .6, .8));
    system.E = PatchField<Rgb>(n, Rgb(0.0));
    system.E[PatchId(7UL)] = Rgb(1, 2, 3);
    std::vector<double> exchange(n * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) exchange[i * n + j] = (1 + std::cos(static_cast<double>(i * j))) / n;
    system.F = testing::rows_from(exchange, system.area);
    return system;
}

TEST(LinearSolvers, AnswerTheSameBytesOnAnyNumberOfThreads)
{
    const RadiositySystem system = large_system();
    for (const Solver solver : all_solvers) {
        if (solver == Solver::progressive) continue;  // shoots on one
        const auto with_threads = [&](std::size_t n) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
            return solved(system, tight(solver, 1e-3));
        };
        const Radiosity one = with_threads(1);
        EXPECT_EQ(one, with_threads(2)) << static_cast<int>(solver);
        EXPECT_EQ(one, with_threads(4)) << static_cast<int>(solver);
    }
}

TEST(LinearSolvers, CanBeStopped)
{
    const RadiositySystem system = cube_system(0.8);
    std::stop_source stop;
    stop.request_stop();
    for (const Solver solver : all_solvers) {
        Radiosity B = system.E;
        EXPECT_THROW(solve(system, B, tight(solver), {stop.get_token(), {}}), Interrupted);
    }
}

// reference-values.md §4, inside of a sphere: F_ij = A_j / ΣA, so that H = mean(E)/(1 − mean ρ) everywhere. No row is
// ever held: the operator is one sum. I − ρF is then the identity and a matrix of rank one, which conjugate gradients
// end on in two iterations.
TEST(LinearSolvers, TakeAnOperatorWithoutRows)
{
    constexpr std::size_t n = 100'000;
    RadiositySystem system;
    system.area = PatchField<double>(n);
    system.rho = PatchField<Rgb>(n);
    system.E = PatchField<Rgb>(n);
    Rgb mean_E(0.0), mean_rho(0.0);
    double area = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const PatchId p(i);
        const auto x = static_cast<double>(i % 97);
        system.area[p] = 1 + x;
        system.rho[p] = Rgb(0.5, x / 100, i % 2 == 0 ? 0.0 : 0.9);
        system.E[p] = i % 1000 == 0 ? Rgb(1, 2, 3) : Rgb(0.0);
        area += system.area[p];
        mean_E += system.area[p] * system.E[p];
        mean_rho += system.area[p] * system.rho[p];
    }
    const Rgb H = mean_E / area / (1.0 - mean_rho / area);
    const LightOperator sphere = [&](const Radiosity& B, Radiosity& arrived) {
        Rgb sum(0.0);
        for (std::size_t i = 0; i < n; ++i) sum += system.area[PatchId(i)] * B[PatchId(i)];
        for (std::size_t i = 0; i < n; ++i) arrived[PatchId(i)] = sum / area;
    };
    EXPECT_LT(asymmetry(sphere, system.area), reciprocal_enough);
    Radiosity by_gradients = system.E, by_bicgstab = system.E;
    EXPECT_LE(solve_conjugate_gradient(system, sphere, by_gradients, tight(Solver::conjugate_gradient)).iterations, 2U);
    EXPECT_TRUE(solve_bicgstab(system, sphere, by_bicgstab, tight(Solver::bicgstab)).converged);
    for (std::size_t i = 0; i < n; ++i) {
        const PatchId p(i);
        for (int band = 0; band < 3; ++band) {
            const double exact = system.E[p][band] + system.rho[p][band] * H[band];
            ASSERT_NEAR(by_gradients[p][band], exact, 1e-7 * H[band]) << i;
            ASSERT_NEAR(by_bicgstab[p][band], exact, 1e-7 * H[band]) << i;
        }
    }
}

TEST(LinearSolvers, AsymmetryTellsReciprocalRowsFromSampledOnes)
{
    RadiositySystem system = cube_system(0.8);
    EXPECT_LT(asymmetry(rows_of(system.F), system.area), 1e-14);
    // One of 600,000 factors a tenth too large.
    system.F.factors[1000] *= 1.1;
    EXPECT_GT(asymmetry(rows_of(system.F), system.area), reciprocal_enough);
    const RadiositySystem sampled = cornell_system({.rays = 128}, 300);
    EXPECT_GT(asymmetry(rows_of(sampled.F), sampled.area), 1e-6);
}

}  // namespace
}  // namespace patchlight
