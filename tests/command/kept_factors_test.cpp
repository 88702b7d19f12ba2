#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class KeptFactorsTest : public CommandTest {
protected:
    Outcome solve(const std::string& run_name, std::vector<std::string> more)
    {
        std::vector<std::string> words{"solve", scene_,          "-o", path(run_name), "--rays",
                                       "64",    "--vertex-rays", "32", "--size",       "32x32"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    /// A run of the scene's own mesh that keeps its factors.
    void keep(const std::vector<std::string>& more = {})
    {
        std::vector<std::string> words{"--refine", "none", "--max-elements", "220", "--keep-factors"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = solve("kept", words);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        ASSERT_TRUE(std::filesystem::exists(factors_));
        EXPECT_THAT(outcome.err, HasSubstr("factors.bin takes up to"));
    }

    /// Paints the floor, which changes ρ, and lights the lamp otherwise, which changes E.
    void change_materials()
    {
        write_text(folder_ / "room.mtl", "newmtl white\nKd .2 .3 .9\nnewmtl red\nKd .6 .1 .1\n"
                                         "newmtl lamp\nKd 0 0 0\nKe 3 20 8\n");
    }

    std::size_t rays_reused(const std::string& run_name) const
    {
        const json timing = json::parse(text_of(folder_ / run_name / "timing.json"));
        return timing.at("cycles").at(0).at("rays_reused").get<std::size_t>();
    }

    /// The mesh of "kept" solved with its factors, and again without them: the same files.
    Outcome expect_same_with_and_without(const std::vector<std::string>& more)
    {
        std::vector<std::string> words{"--mesh", path("kept")};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome with = solve("with", words);
        EXPECT_EQ(with.code, 0) << with.err;
        std::filesystem::rename(factors_, folder_ / "aside.bin");
        const Outcome without = solve("without", words);
        EXPECT_EQ(without.code, 0) << without.err;
        EXPECT_THAT(without.err, Not(HasSubstr("factors.bin")));
        std::filesystem::rename(folder_ / "aside.bin", factors_);
        const auto a = lasting_files_in(folder_ / "with"), b = lasting_files_in(folder_ / "without");
        EXPECT_EQ(a.size(), b.size());
        for (const auto& [name, bytes] : b) {
            EXPECT_TRUE(a.at(name) == bytes) << name << " differs";
        }
        return with;
    }

    const std::string scene_ = write_scene();
    const std::filesystem::path factors_ = folder_ / "kept/factors.bin";
};

TEST_F(KeptFactorsTest, OtherLightOnTheSameMeshTracesNothingAndIsTheSameToTheByte)
{
    keep();
    change_materials();
    const Outcome with = expect_same_with_and_without({});
    EXPECT_THAT(with.err, HasSubstr("used again"));
    const json record = json::parse(text_of(folder_ / "with/run.json"));
    EXPECT_EQ(rays_reused("with"), record.at("cycles").at(0).at("rays").get<std::size_t>()) << "all of them";
    EXPECT_GT(rays_reused("with"), 0U);
    EXPECT_EQ(rays_reused("without"), 0U);
}

TEST_F(KeptFactorsTest, KeepingThemChangesNoOtherFile)
{
    keep();
    ASSERT_EQ(solve("plain", {"--refine", "none", "--max-elements", "220"}).code, 0);
    auto kept = lasting_files_in(folder_ / "kept");
    kept.erase("factors.bin");
    EXPECT_TRUE(kept == lasting_files_in(folder_ / "plain"));
    // On the same mesh again, with one thread: the same bytes.
    ASSERT_EQ(solve("again", {"--mesh", path("kept"), "--keep-factors", "--threads", "1"}).code, 0);
    EXPECT_TRUE(text_of(folder_ / "again/factors.bin") == text_of(factors_));
    EXPECT_TRUE(text_of(folder_ / "again/solution.glb") == text_of(folder_ / "kept/solution.glb"));
}

TEST_F(KeptFactorsTest, OtherSolversUseThemToo)
{
    keep();
    for (const char* solver : {"conjugate-gradient", "progressive"}) {
        std::filesystem::remove_all(folder_ / "with");
        std::filesystem::remove_all(folder_ / "without");
        EXPECT_THAT(expect_same_with_and_without({"--solver", solver}).err, HasSubstr("used again")) << solver;
    }
}

TEST_F(KeptFactorsTest, QuadraticElementsOfSampledLightKeepTheirs)
{
    keep({"--elements", "quadratic", "--direct", "sampled"});
    change_materials();
    EXPECT_THAT(expect_same_with_and_without({"--elements", "quadratic", "--direct", "sampled"}).err,
                HasSubstr("used again"));
}

TEST_F(KeptFactorsTest, WhatTheyDependOnIsNamedAndTracedAnew)
{
    keep();
    const Outcome seed = expect_same_with_and_without({"--seed", "2"});
    EXPECT_THAT(seed.err, HasSubstr("not used, for other \"form_factors\""));
    // A wall that reflects no more gathers nothing: its nodes' rows would be empty.
    write_text(folder_ / "room.mtl", "newmtl white\nKd .7 .7 .7\nnewmtl red\nKd 0 0 0\n"
                                     "newmtl lamp\nKd 0 0 0\nKe 10 9 8\n");
    const Outcome dark = solve("dark", {"--mesh", path("kept")});
    EXPECT_EQ(dark.code, 0) << dark.err;
    EXPECT_THAT(dark.err, HasSubstr("not used, for other \"scene\""));
}

TEST_F(KeptFactorsTest, BrokenOnesAreWarnedOfAndNeverUsed)
{
    keep();
    const std::string whole = text_of(factors_);
    std::string flipped = whole;
    flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
    for (const std::string& bytes :
         {flipped, whole.substr(0, whole.size() / 2), std::string(), std::string("thesis")}) {
        write_text(factors_, bytes);
        std::filesystem::remove_all(folder_ / "with");
        std::filesystem::remove_all(folder_ / "without");
        const Outcome with = expect_same_with_and_without({});
        EXPECT_THAT(with.err, HasSubstr("warning: "));
        EXPECT_THAT(with.err, HasSubstr("traced anew"));
    }
}

TEST_F(KeptFactorsTest, RefusedWhereTheyMakeNoSenseOrDontFit)
{
    const Outcome adaptive = solve("run", {"--keep-factors"});
    EXPECT_EQ(adaptive.code, 2);
    EXPECT_THAT(adaptive.err, HasSubstr("--refine none"));
    const Outcome large =
        solve("run", {"--refine", "none", "--max-elements", "20000", "--keep-factors", "--memory", "200MB"});
    EXPECT_EQ(large.code, 5) << large.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "run"));
}

}  // namespace
}  // namespace patchlight::testing
