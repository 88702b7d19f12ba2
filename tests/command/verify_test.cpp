#include "apps/run/sha256.h"
#include "apps/run/stored_solution.h"
#include "tests/command/command_runner.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace patchlight::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class VerifyTest : public CommandTest {
protected:
    void solve(const std::string& scene)
    {
        const Outcome outcome = run(small({"solve", scene, "-o", path("run"), "--quiet", "--pictures", "none"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    json verified(std::vector<std::string> more)
    {
        more.insert(more.begin(), {"verify", path("run"), "--json", "--quiet"});
        const Outcome outcome = run(more);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return json::parse(outcome.out);
    }
};

TEST_F(VerifyTest, ReportsTheErrorWithItsIntervalAndAVerdict)
{
    solve(write_scene());
    const json v = verified({"--points", "300", "--seed", "5"});
    EXPECT_EQ(v.at("points"), 300);
    EXPECT_GT(v.at("l2").get<double>(), 0.003) << "220 elements and 16 rays a vertex";
    EXPECT_LT(v.at("l2").get<double>(), 0.5);
    EXPECT_LE(v.at("l2_ci").at(0), v.at("l2"));
    EXPECT_GE(v.at("l2_ci").at(1), v.at("l2"));
    const json record = json::parse(text_of(path("run/run.json")));
    EXPECT_EQ(v.at("estimated_error"), record.at("cycles").back().at("estimated_error"));
    EXPECT_NEAR(v.at("effectivity").get<double>(), v.at("estimated_error").get<double>() / v.at("l2").get<double>(),
                1e-9);
    std::size_t points = 0;
    double share = 0;
    for (const json& surface : v.at("surfaces")) {
        points += surface.at("points").get<std::size_t>();
        share += surface.at("share").get<double>();
        EXPECT_TRUE(surface.at("object") == "floor" || surface.at("object") == "wall") << "the lamp is black";
        EXPECT_EQ(surface.at("area"), 1);
    }
    EXPECT_EQ(points, 300U);
    EXPECT_NEAR(share, 1, 1e-9);
    const json first = verified({"--points", "300", "--seed", "5", "--cycle", "first"});
    EXPECT_EQ(first.at("cycle"), 0);
    EXPECT_LT(first.at("elements"), v.at("elements"));

    const Outcome text = run({"verify", path("run"), "--points", "50", "--paths", "64"});
    EXPECT_EQ(text.code, 0);
    EXPECT_THAT(text.out, AllOf(HasSubstr("relative L2"), HasSubstr("estimate"), HasSubstr("floor")));
    EXPECT_THAT(text.err, HasSubstr("M rays in"));
}

// B − E made larger by 2 % in what is stored, in a room where B is the same everywhere and nearly exact.
TEST_F(VerifyTest, MeasuresAPerturbationOfWhatIsStored)
{
    solve(PATCHLIGHT_DATA "/scenes/furnace.obj");
    const json exact = verified({"--points", "500", "--paths", "1024"});
    EXPECT_LT(exact.at("l2_ci").at(0), 2e-3) << "the solver's tolerance is 1e-4";
    const std::filesystem::path file = path("run/solution.glb");
    StoredSolution s = read_solution(file);
    const Rgb E = s.scene.materials.front().emission;
    for (Rgb& B : s.vertex_B.values()) B = E + 1.02 * (B - E);
    const std::string before = sha256_hex(text_of(file));
    write_text(file, encode_solution(s.scene, s.mesh, s.B, s.vertex_B, s.eta, s.edge));
    EXPECT_EQ(run({"verify", path("run")}).code, 3) << "a changed file";
    // As if the run had written it: the last cycle's, too, for one digest stands for both.
    const std::string last = fmt::format("run/cycles/{:02}/solution.glb", exact.at("cycle").get<int>());
    write_text(path(last), text_of(file));
    write_text(path("run/run.json"),
               std::regex_replace(text_of(path("run/run.json")), std::regex(before), sha256_hex(text_of(file))));
    const json off = verified({"--points", "500", "--paths", "1024"});
    // The interval, and the solver's own error.
    EXPECT_LT(off.at("l2_ci").at(0), 0.021);
    EXPECT_GT(off.at("l2_ci").at(1), 0.019);
    EXPECT_NEAR(off.at("l2").get<double>(), 0.02, 0.005);
    EXPECT_EQ(off.at("verdict"), "too small") << "the stored estimate knows nothing of it";
}

TEST_F(VerifyTest, AllCyclesAreMeasuredAsEachAloneWouldBe)
{
    solve(write_scene());
    const json all = verified({"--points", "300", "--paths", "128", "--cycle", "all"});
    const json record = json::parse(text_of(path("run/run.json")));
    ASSERT_EQ(all.at("cycles").size(), record.at("cycles").size());
    EXPECT_EQ(all.at("l2"), all.at("cycles").back().at("l2"));
    const json first = verified({"--points", "300", "--paths", "128", "--cycle", "0"});
    for (const char* key : {"l2", "l2_ci", "relrms", "estimated_error", "verdict", "within_twice_the_estimate"})
        EXPECT_EQ(all.at("cycles").at(0).at(key), first.at(key)) << key;
    EXPECT_GT(first.at("l2"), all.at("l2")) << "refined for something";
    EXPECT_THAT(run({"verify", path("run"), "--points", "50", "--cycle", "all"}).out, HasSubstr("measured"));
}

TEST_F(VerifyTest, PrintsTheSameOnAnyNumberOfThreadsButForTheTime)
{
    solve(write_scene());
    const auto printed = [&](const char* threads) {
        json v = verified({"--points", "200", "--paths", "128", "--threads", threads});
        v.erase("seconds");
        v.erase("cpu_seconds");
        return v.dump();
    };
    EXPECT_EQ(printed("1"), printed("3"));
}

TEST_F(VerifyTest, WhatIsNoRunOrHasNoSuchCycleIsTwo)
{
    EXPECT_EQ(run({"verify", path("nowhere")}).code, 2);
    EXPECT_EQ(run({"verify", path("scratch")}).code, 2);
    solve(write_scene());
    const Outcome outcome = run({"verify", path("run"), "--cycle", "99"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(StartsWith("error[folder]: "), HasSubstr("no cycle 99")));
    write_text(path("run/solution.glb"), "glTF");
    EXPECT_EQ(run({"verify", path("run")}).code, 3);
}

TEST_F(VerifyTest, CanBeInterrupted)
{
    solve(write_scene());
    RunningCommand tracing({"verify", path("run"), "--points", "100000", "--paths", "1000000"}, folder_ / "scratch",
                           {});
    std::this_thread::sleep_for(std::chrono::milliseconds(800));
    const auto begin = std::chrono::steady_clock::now();
    tracing.send(SIGINT);
    const Outcome outcome = tracing.wait();
    EXPECT_EQ(outcome.code, 130);
    EXPECT_EQ(outcome.out, "");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

}  // namespace
}  // namespace patchlight::testing
