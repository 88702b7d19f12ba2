#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

/// Keys stay in their order, as the program compares options.
using json = nlohmann::ordered_json;
using ::testing::HasSubstr;

class RerunTest : public CommandTest {
protected:
    void solve(std::vector<std::string> more = {})
    {
        std::vector<std::string> words{"solve", write_scene(), "-o", path("run")};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(small(words));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    void expect_same()
    {
        const Outcome outcome = run({"rerun", path("run"), "-o", path("again"), "--threads", "1"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("to the byte"));
        const auto expected = lasting_files_in(folder_ / "run"), actual = lasting_files_in(folder_ / "again");
        ASSERT_EQ(actual.size(), expected.size());
        for (const auto& [name, bytes] : expected) {
            EXPECT_TRUE(actual.at(name) == bytes) << name;
        }
    }

    void change(const std::string& name, const std::function<void(json&)>& edit)
    {
        json stored = json::parse(text_of(folder_ / name));
        edit(stored);
        write_text(folder_ / name, stored.dump(2));
    }

    Outcome files_only(std::vector<std::string> more = {})
    {
        more.insert(more.begin(), {"verify", path("run"), "--files-only"});
        return run(more);
    }
};

TEST_F(RerunTest, NeedsNothingButTheRun)
{
    solve({"--snapshots", "1,2", "--view", "front", "--emitter", "lamp=5,6,7"});
    for (const char* name : {"room.obj", "room.mtl", "room.view.json"}) {
        std::filesystem::remove(folder_ / name);
    }
    expect_same();
}

TEST_F(RerunTest, OfOneForAViewWithoutPicturesIsTheSame)
{
    solve({"--for-view", "front", "--pictures", "none", "--refine", "intensity"});
    expect_same();
}

// A box on the floor: contact lines, which depend on how the scene was read.
TEST_F(RerunTest, OfASceneWithContactLinesIsTheSame)
{
    const Outcome solved =
        run({"solve", PATCHLIGHT_DATA "/scenes/cornell-box.obj", "--unit", "mm", "-o", path("run"), "--max-elements",
             "1200", "--vertex-rays", "64", "--size", "48x48", "--target-error", "0.0001", "--iterations", "4"});
    ASSERT_EQ(solved.code, 4) << "an unreached target is reproduced, too: " << solved.err;
    expect_same();
}

TEST_F(RerunTest, OnAGivenMeshIsTheSameWithoutTheOtherRun)
{
    solve();
    std::filesystem::rename(folder_ / "run", folder_ / "first");
    const Outcome solved =
        run({"solve", path("room.obj"), "-o", path("run"), "--mesh", path("first"), "--size", "32x32"});
    ASSERT_EQ(solved.code, 0) << solved.err;
    std::filesystem::remove_all(folder_ / "first");
    expect_same();
}

TEST_F(RerunTest, SaysWhichFilesDiffer)
{
    solve();
    // As a program would leave it whose pictures were others.
    write_text(folder_ / "run/after.png", "another picture");
    const Outcome broken = run({"rerun", path("run"), "-o", path("again")});
    EXPECT_EQ(broken.code, 3);
    EXPECT_THAT(broken.err, HasSubstr("after.png"));
    change("run/run.json", [&](json& record) { record["files"].erase("after.png"); });
    const Outcome outcome = run({"rerun", path("run"), "-o", path("again"), "--json"});
    EXPECT_EQ(outcome.code, 7) << outcome.err;
    const json answer = json::parse(outcome.out);
    EXPECT_FALSE(answer.at("identical").get<bool>());
    ASSERT_EQ(answer.at("differing").size(), 1U) << answer.dump();
    EXPECT_EQ(answer.at("differing").at(0).at("file"), "after.png");
    EXPECT_THAT(outcome.err, HasSubstr("after.png"));
}

TEST_F(RerunTest, RefusesWhatItCantRepeat)
{
    solve();
    const std::string whole = text_of(folder_ / "run/run.json");
    change("run/run.json", [](json& record) { record["status"] = "interrupted"; });
    const Outcome unfinished = run({"rerun", path("run"), "-o", path("again")});
    EXPECT_EQ(unfinished.code, 2);
    EXPECT_THAT(unfinished.err, HasSubstr("interrupted"));
    write_text(folder_ / "run/run.json", whole);
    change("run/run.json", [](json& record) { record["options"]["solve"]["from_the_future"] = 1; });
    const Outcome future = run({"rerun", path("run"), "-o", path("again")});
    EXPECT_EQ(future.code, 3);
    EXPECT_THAT(future.err, HasSubstr("options"));
    write_text(folder_ / "run/run.json", whole);
    change("run/run.json", [](json& record) { record["scene"]["content_sha256"] = "0"; });
    EXPECT_EQ(run({"rerun", path("run"), "-o", path("again")}).code, 3);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "again"));
    EXPECT_EQ(run({"rerun", path("nothing"), "-o", path("again")}).code, 2);
}

TEST_F(RerunTest, FilesAreCheckedWithoutTracing)
{
    solve();
    const json record = json::parse(text_of(folder_ / "run/run.json"));
    for (const auto& [name, bytes] : lasting_files_in(folder_ / "run")) {
        EXPECT_TRUE(name == "run.json" || record.at("files").contains(name)) << name;
    }
    EXPECT_EQ(files_only().code, 0);
    const json good = json::parse(files_only({"--json"}).out);
    EXPECT_EQ(good.at("files"), record.at("files").size());
    EXPECT_TRUE(good.at("problems").empty());

    for (const auto& [name, digest] : record.at("files").items()) {
        const std::filesystem::path file = folder_ / "run" / name;
        std::string bytes = text_of(file);
        const std::string whole = bytes;
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
        write_text(file, bytes);
        const Outcome outcome = files_only({"--json"});
        EXPECT_EQ(outcome.code, 3) << name;
        EXPECT_EQ(json::parse(outcome.out).at("problems").at(0).at("file"), name);
        EXPECT_THAT(outcome.err, HasSubstr("error[files]"));
        std::filesystem::remove(file);
        EXPECT_THAT(files_only().err, HasSubstr("is missing"));
        write_text(file, whole);
    }
    EXPECT_EQ(files_only().code, 0);
    write_text(folder_ / "run/cycles/00/solution.glb", "broken");
    EXPECT_EQ(run({"verify", path("run"), "--points", "10"}).code, 3) << "before anything is traced";
}

TEST_F(RerunTest, FilesOutsideTheRunAreNeverRead)
{
    solve();
    change("run/run.json", [](json& record) {
        record["files"]["../room.obj"] = "0";
        record["files"]["/etc/passwd"] = "0";
    });
    const Outcome outcome = files_only({"--json"});
    EXPECT_EQ(outcome.code, 3);
    const json problems = json::parse(outcome.out).at("problems");
    EXPECT_GE(problems.size(), 2U);
    for (const json& problem : problems) {
        EXPECT_EQ(problem.at("cause"), "is outside the run's folder");
    }
}

TEST_F(RerunTest, UnfinishedRunsGoOnWhereTheNumbersWouldBeTheSame)
{
    solve();
    const std::string whole = text_of(folder_ / "run/run.json");
    change("run/run.json", [](json& record) {
        record["status"] = "running";
        record["tool"]["commit"] = "another";
    });
    const std::vector<std::string> words = small({"solve", path("room.obj"), "-o", path("run")});
    EXPECT_EQ(run(words).code, 0);
    EXPECT_EQ(text_of(folder_ / "run/run.json"), whole);
    change("run/run.json", [](json& record) {
        record["status"] = "running";
        record["tool"]["numeric"] = "0123456789abcdef";
    });
    const Outcome other = run(words);
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("other numbers"));
}

}  // namespace
}  // namespace patchlight::testing
