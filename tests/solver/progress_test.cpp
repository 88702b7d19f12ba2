#include "solver/adaptive.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace patchlight {
namespace {

/// All that was told of each stage of each cycle.
using Told = std::map<std::pair<int, std::string>, std::vector<Progress>>;

Told told_of(const AdaptiveOptions& options)
{
    const Scene scene = testing::cube_inside(
        {0, 1, 0, 0, 0, 0}, {{.name = "wall", .reflectance = Rgb(0.7)}, {.name = "lamp", .emission = Rgb(8, 4, 2)}});
    Told told;
    AdaptiveObservers observers;
    observers.on_progress = [&](const Progress& p) { told[{p.cycle, std::string(p.stage)}].push_back(p); };
    solve_adaptively(scene, options, observers);
    return told;
}

TEST(Progress, NeverFallsWithinAStage)
{
    AdaptiveOptions options;
    options.max_elements = 800;
    for (const Solver solver : {Solver::gauss_seidel, Solver::progressive, Solver::hierarchical}) {
        options.final.solver = solver;
        for (const auto& [stage, states] : told_of(options)) {
            double fraction = 0;
            std::size_t rays = 0;
            for (const Progress& p : states) {
                EXPECT_GE(p.fraction, fraction) << stage.second;
                EXPECT_LE(p.fraction, 1) << stage.second;
                EXPECT_GE(p.rays, rays) << stage.second;
                fraction = p.fraction;
                rays = p.rays;
            }
        }
    }
}

TEST(Progress, OfTheIndirectStageRunsOverAllOfIt)
{
    AdaptiveOptions options;
    options.max_elements = 2000;
    const Told told = told_of(options);
    const auto& states = told.at({0, "indirect"});
    // By tenths: its many loops would each fill them all.
    std::vector<std::size_t> tenths(10);
    for (const Progress& p : states) ++tenths[std::min<std::size_t>(9, static_cast<std::size_t>(10 * p.fraction))];
    EXPECT_GT(states.back().fraction, 0.95);
    EXPECT_GE(10 - std::ranges::count(tenths, 0U), 6) << "most tenths are passed through";
    EXPECT_LT(tenths[9], states.size() / 2) << "it doesn't wait at the end";
    EXPECT_GT(states.back().rays, 0U);
}

TEST(Progress, TellsTheResidualOrTheUnshotShareOfASolve)
{
    AdaptiveOptions options;
    options.refine = Refine::none;
    options.meshing.max_elements = 200;
    const Told swept = told_of(options);
    EXPECT_GT(swept.at({0, "solve"}).back().residual, 0);
    EXPECT_LE(swept.at({0, "solve"}).back().residual, options.final.tolerance);
    EXPECT_EQ(swept.at({0, "solve"}).back().unshot, -1);
    options.final.solver = Solver::progressive;
    const Told shot = told_of(options);
    EXPECT_GT(shot.at({0, "solve"}).back().unshot, 0);
}

}  // namespace
}  // namespace patchlight
