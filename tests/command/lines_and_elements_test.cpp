#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string wall = PATCHLIGHT_DATA "/scenes/wall-on-floor.obj";

class InspectLines : public CommandTest {};

TEST_F(InspectLines, AWallOnAFloorHasItsFootAsTheStrongest)
{
    const Outcome outcome = run({"inspect", wall, "--lines", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto lines = nlohmann::json::parse(outcome.out).at("lines");
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), [](const auto& l) { return l.at("kind") == "contact"; }), 1);
    const auto& foot = lines.at(0);
    EXPECT_EQ(foot.at("kind"), "contact");
    EXPECT_EQ(foot.at("object"), "receiver");
    // From (.52, .25) to (.52, .75), one way or the other; light jumps to 0 behind the wall.
    for (const char* end : {"from", "to"}) {
        EXPECT_NEAR(foot.at(end).at(0).get<double>(), 0.52, 1e-9);
        EXPECT_NEAR(std::abs(foot.at(end).at(1).get<double>() - 0.5), 0.25, 1e-9);
        EXPECT_NEAR(foot.at(end).at(2).get<double>(), 0, 1e-9);
    }
    EXPECT_GT(foot.at("value").get<double>(), 0.1);
    for (const auto& line : lines) {
        EXPECT_GE(line.at("slope").get<double>(), 0);
        EXPECT_GE(line.at("second").get<double>(), 0);
        EXPECT_TRUE(line.at("surface").is_number_unsigned());
    }
}

TEST_F(InspectLines, TheTableCountsByKindAndShowsTwentyRows)
{
    const Outcome few = run({"inspect", wall, "--lines"});
    EXPECT_EQ(few.code, 0);
    for (const char* shown : {"contact                  1       0.5 m", "EEE                      0", "VE ", "plane"}) {
        EXPECT_THAT(few.out, HasSubstr(shown));
    }
    EXPECT_THAT(few.out, Not(HasSubstr("more; --json")));
    const Outcome many = run({"inspect", PATCHLIGHT_DATA "/scenes/cornell-box.obj", "--unit", "mm", "--lines"});
    EXPECT_EQ(many.code, 0);
    EXPECT_THAT(many.out, HasSubstr("more; --json lists all"));
}

TEST_F(InspectLines, AreOnlyLookedForWhenAskedFor)
{
    EXPECT_THAT(run({"inspect", wall}).out, Not(HasSubstr("discontinuity")));
    EXPECT_THAT(run({"inspect", wall, "--json"}).out, Not(HasSubstr("\"lines\"")));
    EXPECT_EQ(run({"inspect", wall, "--line"}).code, 2);
    EXPECT_EQ(run({"inspect", path("missing.obj"), "--lines"}).code, 3);
}

class QuadraticElements : public CommandTest {
protected:
    std::vector<double> probed(const std::string& run_folder, const std::string& points)
    {
        std::istringstream rows(run({"probe", run_folder, "--points", points}).out);
        std::vector<double> values;
        std::string row;
        std::getline(rows, row);
        while (std::getline(rows, row)) {
            std::istringstream fields(row);
            std::string field;
            for (int k = 0; k < 4; ++k) std::getline(fields, field, ',');
            values.push_back(std::stod(field));
        }
        return values;
    }
};

TEST_F(QuadraticElements, AreStoredProbedRenderedAndResumed)
{
    const std::string scene = write_scene();
    ASSERT_EQ(run(small({"solve", scene, "-o", path("linear")})).code, 0);
    ASSERT_EQ(run(small({"solve", scene, "-o", path("quadratic"), "--elements", "quadratic"})).code, 0);
    write_text(path("points.csv"), "x,y,z\n0.31,0,0.52\n0.9,0,0.13\n0.5,0.31,0\n0.17,0.83,0\n");
    const auto linear = probed(path("linear"), path("points.csv")),
               quadratic = probed(path("quadratic"), path("points.csv"));
    ASSERT_EQ(linear.size(), 4U);
    ASSERT_EQ(quadratic.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NE(linear[i], quadratic[i]);
        // On 220 elements linear ones are off by a fifth where light is strongly curved.
        EXPECT_NEAR(quadratic[i] / linear[i], 1, 0.3) << "the same light, on the same mesh";
    }
    for (const char* name : {"linear", "quadratic"}) {
        EXPECT_EQ(run({"render", path(name), "-o", path(std::string(name) + ".png"), "--size", "40x40"}).code, 0);
    }
    EXPECT_NE(text_of(path("linear.png")), text_of(path("quadratic.png")));
    EXPECT_EQ(run(small({"solve", scene, "-o", path("quadratic"), "--elements", "quadratic"})).code, 0) << "finished";
    EXPECT_EQ(run(small({"solve", scene, "-o", path("quadratic")})).code, 2) << "a run with other options";
    EXPECT_EQ(run({"solve", scene, "-o", path("cubic"), "--elements", "cubic"}).code, 2);
}

TEST_F(QuadraticElements, AnExportedFileHoldsThemToo)
{
    const std::string scene = write_scene();
    ASSERT_EQ(run(small({"solve", scene, "-o", path("run"), "--elements", "quadratic", "--pictures", "none"})).code, 0);
    ASSERT_EQ(run({"export", path("run"), "--format", "glb", "-o", path("out.glb")}).code, 0);
    EXPECT_EQ(text_of(path("out.glb")), text_of(path("run/solution.glb")));
}

}  // namespace
}  // namespace patchlight::testing
