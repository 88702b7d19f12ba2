// A system of three patches, solved by hand.
#include "solver/solve.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

/// F between three patches of areas 1, 2 and 4, reciprocal (A_i F_ij = A_j F_ji), every row summing to 1.
/// A F: 12 → .6, 13 → .4, 23 → 1.4; the third keeps 2.2 for itself (it is curved).
RadiositySystem three_patches()
{
    RadiositySystem system;
    system.area = PatchField<double>(std::vector<double>{1, 2, 4});
    system.E = PatchField<Rgb>(std::vector<Rgb>{Rgb(10, 5, 0), Rgb(0.0), Rgb(0.0)});
    system.rho = PatchField<Rgb>(std::vector<Rgb>{Rgb(0.0), Rgb(0.5), Rgb(0.25, 0.5, 0.75)});
    system.F.row_start = {0, 2, 4, 7};
    system.F.columns = {1, 2, 0, 2, 0, 1, 2};
    system.F.factors = {0.6, 0.4, 0.3, 0.7, 0.1, 0.35, 0.55};
    system.F.raw_sum = system.F.escaped = system.F.backs = PatchField<double>(3, 0.0);
    return system;
}

/// B_1 = 10; B_2 = .5(.3·10 + .7 B_3); B_3 = .25(.1·10 + .35 B_2 + .55 B_3)  (red)
/// → B_3 (1 − .1375 − .25·.35·.35) = .25 + .25·.35·1.5 → B_3 = .38125/.831875, B_2 = 1.5 + .35 B_3.
const double B3_red = 0.38125 / 0.831875, B2_red = 1.5 + 0.35 * B3_red;

// One sweep by hand: B_2 = .5(.3·10 + .7·0) = 1.5; then B_3 = .25(1 + .35·1.5 + 0) = .38125.
TEST(ThreePatches, OneSweepOfGaussSeidel)
{
    const RadiositySystem system = three_patches();
    Radiosity B = system.E;
    solve_gathering(system, B, {.solver = Solver::gauss_seidel, .max_sweeps = 1});
    EXPECT_EQ(B[PatchId(0UL)], system.E[PatchId(0UL)]) << "the emitter reflects nothing";
    EXPECT_NEAR(B[PatchId(1UL)].r, 1.5, 1e-14);
    EXPECT_NEAR(B[PatchId(2UL)].r, 0.38125, 1e-14);
    EXPECT_EQ(B[PatchId(2UL)].b, 0) << "no blue light in the room";
}

// Jacobi's first sweep takes all values from before: patch 3 doesn't see patch 2's new light, B_3 = .25·1.
TEST(ThreePatches, OneSweepOfJacobi)
{
    const RadiositySystem system = three_patches();
    Radiosity B = system.E;
    const SolveReport report = solve_gathering(system, B, {.solver = Solver::jacobi, .max_sweeps = 1});
    EXPECT_NEAR(B[PatchId(1UL)].r, 1.5, 1e-14);
    EXPECT_NEAR(B[PatchId(2UL)].r, 0.25, 1e-14);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(report.iterations, 1U);
}

TEST(ThreePatches, AllSolversReachTheHandSolution)
{
    const RadiositySystem system = three_patches();
    for (const Solver solver : {Solver::jacobi, Solver::gauss_seidel, Solver::conjugate_gradient, Solver::bicgstab}) {
        Radiosity B = system.E;
        const SolveReport report = solve(system, B, {.solver = solver, .tolerance = 1e-10});
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(B[PatchId(1UL)].r, B2_red, 1e-6);
        EXPECT_NEAR(B[PatchId(2UL)].r, B3_red, 1e-6);
    }
    // Shooting takes columns: F_ji for a shooter i.
    const ColumnSource column_of = [](PatchId shooter, std::span<double> column) -> std::size_t {
        const double F[3][3] = {{0, 0.6, 0.4}, {0.3, 0, 0.7}, {0.1, 0.35, 0.55}};
        for (std::size_t j = 0; j < 3; ++j) column[j] = F[j][shooter.value];
        return 0;
    };
    for (const ShootingOrder order : {ShootingOrder::unshot_power, ShootingOrder::unshot_radiosity}) {
        Radiosity B;
        const SolveReport report =
            solve_shooting(system, column_of, B,
                           {.solver = Solver::progressive, .tolerance = 1e-10, .max_sweeps = 1000, .order = order});
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(B[PatchId(1UL)].r, B2_red, 1e-6);
        EXPECT_NEAR(B[PatchId(2UL)].r, B3_red, 1e-6);
    }
}

// Σ A|B − B̃| must lie below the bound that shooting stops on, after any number of shots, in each band.
TEST(ThreePatches, TheShootingBoundHolds)
{
    const RadiositySystem system = three_patches();
    const ColumnSource column_of = [](PatchId shooter, std::span<double> column) -> std::size_t {
        const double F[3][3] = {{0, 0.6, 0.4}, {0.3, 0, 0.7}, {0.1, 0.35, 0.55}};
        for (std::size_t j = 0; j < 3; ++j) column[j] = F[j][shooter.value];
        return 0;
    };
    Radiosity exact;
    solve_shooting(system, column_of, exact, {.tolerance = 1e-13, .max_sweeps = 10000});
    double last = 1e9;
    for (const double tolerance : {0.3, 0.1, 0.03, 0.01, 0.001}) {
        Radiosity B;
        const SolveReport report = solve_shooting(system, column_of, B, {.tolerance = tolerance, .max_sweeps = 1000});
        Rgb error(0.0), total(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            error += system.area[PatchId(i)] * glm::abs(exact[PatchId(i)] - B[PatchId(i)]);
            total += system.area[PatchId(i)] * B[PatchId(i)];
        }
        for (int band = 0; band < 2; ++band) EXPECT_LE(error[band] / total[band], report.residual + 1e-12);
        EXPECT_LE(report.residual, tolerance);
        EXPECT_LE(report.residual, last);
        last = report.residual;
    }
}

// The ambient term spreads what is unshot: right after the emitter's shot it must bring the total nearer.
TEST(ThreePatches, TheAmbientTermBringsAnEarlyAnswerNearer)
{
    const RadiositySystem system = three_patches();
    const ColumnSource column_of = [](PatchId shooter, std::span<double> column) -> std::size_t {
        const double F[3][3] = {{0, 0.6, 0.4}, {0.3, 0, 0.7}, {0.1, 0.35, 0.55}};
        for (std::size_t j = 0; j < 3; ++j) column[j] = F[j][shooter.value];
        return 0;
    };
    const auto total = [&](const Radiosity& B) {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += system.area[PatchId(i)] * B[PatchId(i)].r;
        return sum;
    };
    Radiosity exact, early, spread;
    solve_shooting(system, column_of, exact, {.tolerance = 1e-12, .max_sweeps = 1000});
    solve_shooting(system, column_of, early, {.tolerance = 0.2, .max_sweeps = 1});
    solve_shooting(system, column_of, spread, {.tolerance = 0.2, .max_sweeps = 1, .ambient = true});
    EXPECT_LT(total(early), total(exact));
    EXPECT_LT(std::abs(total(spread) - total(exact)), std::abs(total(early) - total(exact)));
}

}  // namespace
}  // namespace patchlight
