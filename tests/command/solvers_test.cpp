#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string box = PATCHLIGHT_DATA "/scenes/cornell-box.obj";

class SolversTest : public CommandTest {
protected:
    /// The Cornell box on a uniform mesh; run.json.
    nlohmann::json solve_box(const std::vector<std::string>& more)
    {
        static int number = 0;
        std::vector<std::string> words{"solve",
                                       box,
                                       "--unit",
                                       "mm",
                                       "-o",
                                       path("run" + std::to_string(number++)),
                                       "--refine",
                                       "none",
                                       "--pictures",
                                       "none",
                                       "--max-elements",
                                       "400",
                                       "--json"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    }
};

TEST_F(SolversTest, EachSolverTellsHowItWent)
{
    for (const char* solver : {"progressive", "jacobi", "gauss-seidel", "conjugate-gradient", "bicgstab"}) {
        const auto record = solve_box({"--solver", solver});
        EXPECT_EQ(record.at("options").at("solve").at("final").at("solver"), solver);
        const auto solve = record.at("cycles").at(0).at("solve");
        EXPECT_EQ(solve.at("solver"), solver);
        EXPECT_TRUE(solve.at("converged").get<bool>());
        const auto history = solve.at("history").get<std::vector<double>>();
        ASSERT_FALSE(history.empty());
        EXPECT_EQ(history.back(), solve.at("residual").get<double>());
        EXPECT_LT(history.back(), history.front()) << solver;
    }
}

TEST_F(SolversTest, WhereLightComesRoundTooOftenForSweepsItSaysSoAndWhatHelps)
{
    std::filesystem::copy_file(PATCHLIGHT_DATA "/scenes/furnace.obj", folder_ / "bright.obj");
    write_text(folder_ / "furnace.mtl", "newmtl furnace\nKd .999 .999 .999\nKe 1 1 1\n");
    const auto solve = [&](const std::string& solver) {
        return run({"solve", path("bright.obj"), "--max-reflectance", ".9995", "--refine", "none", "--pictures", "none",
                    "--max-elements", "200", "--solver", solver, "-o", path(solver), "--json"});
    };
    const Outcome sweeps = solve("gauss-seidel");
    EXPECT_EQ(sweeps.code, 4);
    EXPECT_THAT(sweeps.err, AllOf(HasSubstr("error[converged]"), HasSubstr("--solver bicgstab")));
    const Outcome helped = solve("bicgstab");
    ASSERT_EQ(helped.code, 0) << helped.err;
    const auto energy = nlohmann::json::parse(helped.out).at("cycles").at(0).at("energy");
    // Rows are single precision: their sums are known to 1e-5 or so, of which light gets 1/(1 − ρ) times.
    EXPECT_NEAR(energy.at("relative_residual").get<double>(), 0, 0.02);
}

// The adaptive mesh of one run, lit by two solvers: the same triangles, and the same light to what links may add.
TEST_F(SolversTest, MethodsAreComparedOnOneMesh)
{
    ASSERT_EQ(
        run({"solve", box, "--unit", "mm", "-o", path("fine"), "--pictures", "none", "--max-elements", "900"}).code, 0);
    const auto on_mesh = [&](const std::string& name, const std::string& solver) {
        const Outcome outcome = run({"solve", box, "--unit", "mm", "-o", path(name), "--mesh", path("fine"),
                                     "--pictures", "none", "--solver", solver, "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    };
    const auto gathered = on_mesh("a", "gauss-seidel"), linked = on_mesh("b", "hierarchical");
    const auto first = nlohmann::json::parse(text_of(folder_ / "fine/run.json"));
    EXPECT_EQ(gathered["cycles"].size(), 1U);
    EXPECT_EQ(gathered["result"]["elements"], first["result"]["elements"]);
    EXPECT_EQ(gathered["options"]["mesh"].get<std::string>().size(), 64U);
    EXPECT_EQ(gathered["options"]["mesh"], linked["options"]["mesh"]);
    EXPECT_NEAR(linked["energy"]["absorbed"].get<double>() / gathered["energy"]["absorbed"].get<double>(), 1, 0.02);
    for (const std::string run_name : {"fine", "a", "b"})
        ASSERT_EQ(run({"export", path(run_name), "--format", "csv", "-o", path(run_name + ".csv")}).code, 0);
    const auto geometry = [&](const std::string& file) {
        // patch, surface, material, centroid, area: what comes before the light.
        std::istringstream lines(text_of(folder_ / file));
        std::string all, line;
        while (std::getline(lines, line)) {
            std::size_t at = 0;
            for (int comma = 0; comma < 7; ++comma) at = line.find(',', at) + 1;
            all += line.substr(0, at) + "\n";
        }
        return all;
    };
    EXPECT_EQ(geometry("a.csv"), geometry("fine.csv"));
    EXPECT_EQ(geometry("b.csv"), geometry("fine.csv"));
}

TEST_F(SolversTest, AMeshOfOtherSurfacesIsRefused)
{
    ASSERT_EQ(
        run({"solve", box, "--unit", "mm", "-o", path("fine"), "--pictures", "none", "--max-elements", "300"}).code, 0);
    const auto refused = [&](const std::vector<std::string>& words) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
        return outcome.err;
    };
    const std::string other = PATCHLIGHT_DATA "/scenes/furnace.obj";
    EXPECT_THAT(refused({"solve", other, "-o", path("other"), "--mesh", path("fine")}), HasSubstr("surfaces"));
    EXPECT_THAT(refused({"solve", box, "-o", path("other"), "--mesh", path("fine")}),
                HasSubstr("only materials may differ"))
        << "in metres instead of millimetres";
    EXPECT_THAT(refused({"solve", box, "-o", path("other"), "--mesh", path("none")}), HasSubstr("none"));
    EXPECT_THAT(refused({"solve", box, "-o", path("other"), "--mesh", path("fine"), "--refine", "both"}),
                HasSubstr("--refine"));
    EXPECT_THAT(refused({"solve", box, "-o", path("other"), "--mesh", path("fine"), "--max-elements", "9"}),
                HasSubstr("--max-elements"));
}

// One linear system by four solvers: the energies agree to the tolerance of 1e-4. Conjugate gradients on hemisphere
// rows solve the reciprocal mean of them, another estimate of the same; on exact rows they solve the same system.
TEST_F(SolversTest, TheyAgreeOnWhereTheLightWent)
{
    const auto absorbed = [&](const std::vector<std::string>& more) {
        return solve_box(more).at("energy").at("absorbed").get<double>();
    };
    const std::vector<std::string> exact{"--form-factors", "exact"};
    const double usual = absorbed(exact);
    for (const char* solver : {"progressive", "jacobi", "conjugate-gradient", "bicgstab"}) {
        EXPECT_NEAR(absorbed({"--form-factors", "exact", "--solver", solver, "--tolerance", "1e-4"}) / usual, 1, 3e-4)
            << solver;
    }
    EXPECT_NEAR(absorbed({"--solver", "conjugate-gradient"}) / absorbed({}), 1, 0.02);
}

TEST_F(SolversTest, ConjugateGradientsTakeFewerIterationsThanSweeps)
{
    const auto iterations = [&](const char* solver) {
        return solve_box({"--form-factors", "exact", "--tolerance", "1e-6", "--solver", solver})
            .at("cycles")
            .at(0)
            .at("solve")
            .at("iterations")
            .get<int>();
    };
    EXPECT_LT(iterations("conjugate-gradient"), iterations("gauss-seidel"));
}

class MemoryTest : public CommandTest {};

TEST_F(MemoryTest, WhatNeedsMoreIsRefusedWithWhatFits)
{
    const Outcome dense = run({"solve", box, "--unit", "mm", "-o", path("run"), "--form-factors", "exact", "--memory",
                               "1GiB", "--max-elements", "100000"});
    EXPECT_EQ(dense.code, 5);
    EXPECT_THAT(dense.err, AllOf(HasSubstr("error[memory]: needs "), HasSubstr("limit 1.0 GiB (--memory)"),
                                 HasSubstr("elements fit"), HasSubstr("--form-factors hemisphere")));
    EXPECT_FALSE(std::filesystem::exists(path("run")));
    const Outcome sampled =
        run({"solve", box, "--unit", "mm", "-o", path("run"), "--memory", "1G", "--max-elements", "1000000"});
    EXPECT_EQ(sampled.code, 5);
    EXPECT_THAT(sampled.err, AllOf(HasSubstr("fewer --rays"), Not(HasSubstr("--form-factors hemisphere"))));
}

// What the message says fits is taken, and a tenth more than that is not.
TEST_F(MemoryTest, WhatIsSaidToFitFits)
{
    const auto solve = [&](const std::string& elements) {
        return run({"solve", box, "--unit", "mm", "-o", path("run"), "--form-factors", "exact", "--memory", "40MB",
                    "--refine", "none", "--pictures", "none", "--max-elements", elements});
    };
    const std::string message = solve("100000").err;
    const std::size_t at = message.find("about ");
    ASSERT_NE(at, std::string::npos) << message;
    const int fits = std::stoi(message.substr(at + 6));
    EXPECT_GT(fits, 100);
    EXPECT_EQ(solve(std::to_string(fits + fits / 9 + 2)).code, 5);
    EXPECT_EQ(solve(std::to_string(fits)).code, 0);
}

}  // namespace
}  // namespace patchlight::testing
