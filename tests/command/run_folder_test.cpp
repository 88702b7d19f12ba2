#include "apps/run/sha256.h"
#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;

class RunFolderTest : public CommandTest {
protected:
    std::vector<std::string> solve(const std::string& run, std::vector<std::string> more = {})
    {
        std::vector<std::string> words{"solve", write_scene(), "-o", path(run)};
        words.insert(words.end(), more.begin(), more.end());
        return small(words);
    }

    std::string status(const std::string& run) const
    {
        const std::string json = text_of(folder_ / run / "run.json");
        const auto at = json.rfind("\"status\": \"");
        return at == std::string::npos ? "none" : json.substr(at + 11, json.find('"', at + 11) - at - 11);
    }

    void expect_no_temporaries() const
    {
        for (const auto& [name, bytes] : files_in(folder_)) {
            EXPECT_EQ(name.find("patchlight-tmp"), std::string::npos) << name;
        }
    }
};

/// A solve of many cycles, a second or so long.
std::vector<std::string> longer(std::vector<std::string> words)
{
    for (const char* word : {"--pictures", "all", "--size", "48x48", "--max-edge", "0.3", "--rays", "64",
                             "--vertex-rays", "64", "--max-elements", "4000", "--iterations", "30"}) {
        words.emplace_back(word);
    }
    return words;
}

TEST_F(RunFolderTest, HoldsWhatTheContractSays)
{
    const Outcome outcome = run(solve("run", {"--snapshots", "1,3"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* name : {"run.json", "timing.json", "solution.glb", "before.png", "after.png", "compare.png",
                             "mesh-before.png", "mesh-after.png", "view.exr", "shots-01.png", "shots-03.png",
                             "cycles/00/solution.glb", "cycles/00/picture.png", "cycles/00/record.json"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "run" / name)) << name;
    }
    EXPECT_EQ(status("run"), "finished");
    EXPECT_EQ(text_of(folder_ / "run/before.png"), text_of(folder_ / "run/cycles/00/picture.png"));
    EXPECT_THAT(outcome.out, HasSubstr("compare.png"));
    expect_no_temporaries();
}

TEST_F(RunFolderTest, WithoutPicturesThereAreNone)
{
    ASSERT_EQ(run(solve("run", {"--pictures", "none", "--quiet"})).code, 0);
    for (const auto& [name, bytes] : files_in(folder_ / "run")) {
        EXPECT_FALSE(name.ends_with(".png") || name.ends_with(".exr")) << name;
    }
}

TEST_F(RunFolderTest, AForeignFolderIsLeftAlone)
{
    std::filesystem::create_directory(folder_ / "run");
    write_text(folder_ / "run/thesis.txt", "mine");
    const Outcome outcome = run(solve("run"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("error[folder]"));
    EXPECT_EQ(files_in(folder_ / "run").size(), 1U);
    write_text(folder_ / "file", "mine");
    EXPECT_EQ(run(solve("file")).code, 2);
    EXPECT_EQ(text_of(folder_ / "file"), "mine");
    write_text(folder_ / "run/run.json", "{\"schema\": \"another\"}");
    EXPECT_EQ(run(solve("run")).code, 2);
}

TEST_F(RunFolderTest, AFinishedRunSaysSoAndStays)
{
    ASSERT_EQ(run(solve("run")).code, 0);
    const auto before = files_in(folder_ / "run");
    const Outcome again = run(solve("run"));
    EXPECT_EQ(again.code, 0);
    EXPECT_THAT(again.err, HasSubstr("finished already"));
    EXPECT_EQ(files_in(folder_ / "run"), before);
    const Outcome other = run(solve("run", {"--seed", "2"}));
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("other options"));
    std::vector<std::string> changed = solve("run");
    write_text(folder_ / "room.mtl", std::string(material_text) + "# a comment changes nothing\n");
    EXPECT_EQ(run(changed).code, 0);
    write_text(folder_ / "room.mtl",
               "newmtl white\nKd .6 .7 .7\nnewmtl red\nKd .6 .1 .1\nnewmtl lamp\nKd 0 0 0\nKe 10 9 8\n");
    const Outcome scene = run(changed);
    EXPECT_EQ(scene.code, 2);
    EXPECT_THAT(scene.err, HasSubstr("earlier state"));
    EXPECT_EQ(files_in(folder_ / "run"), before);
}

// A cycle with a forged digest: what it holds must not be taken for light on this scene's surfaces.
TEST_F(RunFolderTest, ACycleOfAnotherSceneIsNotGoneOnFrom)
{
    ASSERT_EQ(run(solve("run", {"--pictures", "none"})).code, 0);
    auto record = nlohmann::ordered_json::parse(text_of(folder_ / "run/run.json"));
    ASSERT_GT(record["cycles"].size(), 1U);
    const std::string box = PATCHLIGHT_DATA "/scenes/cornell-box.obj";
    ASSERT_EQ(
        run({"solve", box, "--unit", "mm", "-o", path("other"), "--pictures", "none", "--max-elements", "200"}).code,
        0);
    const std::string bytes = text_of(folder_ / "other/cycles/00/solution.glb");
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "run/cycles"))
        if (entry.path().filename() != "00") std::filesystem::remove_all(entry.path());
    write_text(folder_ / "run/cycles/00/solution.glb", bytes);
    auto cycle = nlohmann::ordered_json::parse(text_of(folder_ / "run/cycles/00/record.json"));
    record["status"] = "interrupted";
    cycle["solution_sha256"] = record["cycles"][0]["solution_sha256"] = record["files"]["cycles/00/solution.glb"] =
        sha256_hex(bytes);
    write_text(folder_ / "run/cycles/00/record.json", cycle.dump());
    write_text(folder_ / "run/run.json", record.dump());
    const Outcome again = run(solve("run", {"--pictures", "none"}));
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.err, HasSubstr("cycle 0 is of another scene"));
}

TEST_F(RunFolderTest, AFolderThatCannotBeMadeIsSix)
{
    std::vector<std::string> words = solve("run");
    words[3] = "/proc/patchlight/run";
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 6);
    EXPECT_THAT(outcome.err, HasSubstr("error[output]: /proc/patchlight"));
}

TEST_F(RunFolderTest, AFullDiskIsSixAndCompleteCyclesStay)
{
    // A file-size limit stands in for the full disk: the small files of the cycles fit, view.exr doesn't.
    std::vector<std::string> words = solve("run");
    words.insert(words.end(), {"--pictures", "all"});
    words[std::find(words.begin(), words.end(), "32x32") - words.begin()] = "256x256";
    const Outcome full = run(words, {.largest_file = 200'000});
    EXPECT_EQ(full.code, 6) << full.err;
    EXPECT_THAT(full.err, HasSubstr("error[output]: "));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "run/cycles/00/record.json"));
    expect_no_temporaries();
    EXPECT_EQ(run(words).code, 0) << "with room again the same command goes on";
    EXPECT_EQ(status("run"), "finished");
}

TEST_F(RunFolderTest, TwoProgramsDoNotWriteOneFolder)
{
    const auto words = longer({"solve", write_scene(), "-o", path("run")});
    RunningCommand first(words, folder_ / "scratch", {});
    ASSERT_TRUE(first.wait_for([&] { return std::filesystem::exists(folder_ / "run/cycles/00/record.json"); }));
    std::filesystem::create_directory(folder_ / "other");
    const Outcome second = RunningCommand(words, folder_ / "other", {}).wait();
    EXPECT_EQ(second.code, 2);
    EXPECT_THAT(second.err, HasSubstr("another patchlight"));
}

class SignalTest : public RunFolderTest, public ::testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(SignalTest, EndsInTimeWithAValidPartThatCanBeResumed)
{
    const auto words = longer({"solve", write_scene(), "-o", path("run")});
    auto whole_words = words;
    whole_words[3] = path("whole");
    ASSERT_EQ(run(whole_words).code, 0);

    RunningCommand running(words, folder_ / "scratch", {});
    ASSERT_TRUE(running.wait_for([&] { return std::filesystem::exists(folder_ / "run/cycles/01/record.json"); }));
    const auto start = std::chrono::steady_clock::now();
    running.send(GetParam().first);
    const Outcome outcome = running.wait();
    // A second is promised; the rest is for a machine that is busy with other things.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1500));
    EXPECT_EQ(outcome.code, GetParam().second);
    EXPECT_EQ(status("run"), GetParam().first == SIGKILL ? "running" : "interrupted");
    EXPECT_EQ(run({"render", path("run"), "-o", path("partial.png"), "--size", "16x16"}).code, 0);
    if (GetParam().first != SIGKILL) {
        expect_no_temporaries();
    }

    const Outcome resumed = run(words);
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("resumed after cycle"));
    expect_no_temporaries();
    const auto expected = lasting_files_in(folder_ / "whole"), actual = lasting_files_in(folder_ / "run");
    ASSERT_EQ(actual.size(), expected.size());
    for (const auto& [name, bytes] : expected) {
        EXPECT_TRUE(actual.at(name) == bytes) << name << " differs from the uninterrupted run's";
    }
}

INSTANTIATE_TEST_SUITE_P(Signals, SignalTest,
                         ::testing::Values(std::pair(SIGINT, 130), std::pair(SIGTERM, 143),
                                           std::pair(SIGKILL, -SIGKILL)),
                         [](const auto& chosen) { return std::string(sigabbrev_np(chosen.param.first)); });

TEST_F(RunFolderTest, ARunThatMissesItsTargetIsFour)
{
    const Outcome outcome = run(solve("run", {"--target-error", "1e-6"}));
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("error[converged]"));
    EXPECT_EQ(status("run"), "not-converged");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "run/compare.png")) << "the answer there is, is kept";
}

}  // namespace
}  // namespace patchlight::testing
