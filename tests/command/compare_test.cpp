#include "apps/imaging/image_file.h"
#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A run of three cycles or so, and what compares and animates it.
class CompareTest : public CommandTest {
protected:
    void SetUp() override
    {
        const Outcome outcome =
            run(small({"solve", write_scene(), "-o", path("run"), "--snapshots", "1,2", "--quiet"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    Outcome compare(const std::string& a, const std::string& b, std::vector<std::string> more = {})
    {
        std::vector<std::string> words{"compare", path(a), path(b), "-o", path("out"), "--size", "32x24"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
};

TEST_F(CompareTest, TwoCyclesOfARunDiffer)
{
    const Outcome outcome = compare("run@first", "run", {"--points", "500", "--json", "--false-color", "lux"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_LT(json["a"]["elements"], json["b"]["elements"]);
    EXPECT_GT(json["a"]["estimated_error"], json["b"]["estimated_error"]);
    EXPECT_GT(json["a"]["seconds"], 0);
    EXPECT_GT(json["b"]["seconds"], json["a"]["seconds"]);
    EXPECT_GT(json["rmse"], 0);
    EXPECT_GT(json["l2"], 0);
    EXPECT_LT(json["l2"], 1);
    EXPECT_GT(json["flip"]["mean"], 0);
    EXPECT_GE(json["flip"]["p95"], json["flip"]["mean"]);
    EXPECT_GE(json["flip"]["max"], json["flip"]["p95"]);
    EXPECT_EQ(json["files"].size(), 8U);
    for (const auto& name : json["files"]) {
        const Image image = read_image(path("out/" + name.get<std::string>())).image;
        EXPECT_GE(image.width, 32) << name;
        EXPECT_GT(*std::max_element(image.rgb.begin(), image.rgb.end()), 0.1F) << name;
    }
    const auto stored = nlohmann::json::parse(text_of(path("out/compare.json")));
    EXPECT_FALSE(stored["a"].contains("seconds")) << "they depend on the machine that solved";
    EXPECT_EQ(stored["rmse"], json["rmse"]);
}

TEST_F(CompareTest, ARunIsEqualToItselfAndTheFolderCanBeWrittenAgain)
{
    ASSERT_EQ(compare("run@first", "run", {"--false-color", "irradiance"}).code, 0);
    const Outcome outcome = compare("run", "run@last",
                                    {"--points", "100", "--fail-above", "flip=0", "--fail-above", "flip-max=0",
                                     "--fail-above", "rmse=0", "--fail-above", "l2=0", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json["rmse"], 0);
    EXPECT_EQ(json["flip"]["max"], 0);
    EXPECT_EQ(json["l2"], 0);
    EXPECT_FALSE(std::filesystem::exists(path("out/false-color.png"))) << "of the earlier comparison";
    const auto before = files_in(path("out"));
    ASSERT_EQ(compare("run", "run@last", {"--points", "100"}).code, 0);
    EXPECT_EQ(files_in(path("out")), before);
}

TEST_F(CompareTest, OverALimitIsSevenAndSaysWhichAndByHowMuch)
{
    const Outcome outcome = compare("run@first", "run", {"--fail-above", "flip-p95=1", "--fail-above", "rmse=1e-9"});
    EXPECT_EQ(outcome.code, 7);
    EXPECT_THAT(outcome.err,
                AllOf(StartsWith("error[over]: rmse is "), HasSubstr("over 1e-09"), Not(HasSubstr("flip"))));
    EXPECT_THAT(outcome.out, HasSubstr("FLIP"));
    EXPECT_TRUE(std::filesystem::exists(path("out/wipe.png"))) << "to see why";
}

TEST_F(CompareTest, DifferentScenesAreTwoWithBoth)
{
    const std::string scene = write_scene("other.obj");
    std::string text = scene_text;
    write_text(scene, text.replace(text.find("v .4 .5 .4"), 10, "v .3 .5 .4"));
    ASSERT_EQ(run(small({"solve", scene, "-o", path("other"), "--quiet"})).code, 0);
    const Outcome outcome = compare("run", "other");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err,
                AllOf(StartsWith("error[compare]: the scenes differ"), HasSubstr("room.obj"), HasSubstr("other.obj")));
    EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(CompareTest, ACameraThatDiffersIsTwoWithBothAndOneThatIsMissingIsNamed)
{
    std::string text = view_text;
    write_text(path("moved.json"), text.replace(text.find("2.4"), 3, "2.9"));
    write_text(path("renamed.json"), text.replace(text.find("front"), 5, "aside"));
    const std::string scene = write_scene();
    ASSERT_EQ(run(small({"solve", scene, "-o", path("moved"), "--view", path("moved.json"), "--quiet"})).code, 0);
    const Outcome outcome = compare("run", "moved");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("the camera \"front\" differs"), HasSubstr("\"from\"")));
    ASSERT_EQ(run(small({"solve", scene, "-o", path("renamed"), "--view", path("renamed.json"), "--quiet"})).code, 0);
    EXPECT_THAT(compare("run", "renamed", {"--view", "aside"}).err, HasSubstr("no camera \"aside\""));
    EXPECT_EQ(compare("run", "renamed", {"--view", "front"}).code, 0) << "the scene's own camera is in both";
}

TEST_F(CompareTest, AForeignFolderIsLeftAlone)
{
    std::filesystem::create_directory(path("out"));
    write_text(path("out/wipe.png"), "mine");
    const Outcome outcome = compare("run@first", "run");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("wipe.png"));
    EXPECT_EQ(text_of(path("out/wipe.png")), "mine");
    const auto before = files_in(path("run"));
    EXPECT_EQ(run({"compare", path("run"), path("run"), "-o", path("run")}).code, 2);
    EXPECT_EQ(run({"compare", path("run"), path("run"), "-o", path("run/run.json")}).code, 2);
    EXPECT_EQ(files_in(path("run")), before);
    EXPECT_EQ(run({"compare", path("run"), path("run"), "-o", "/proc/patchlight"}).code, 6);
}

TEST_F(CompareTest, WhatIsNoRunOrNoCycleIsTwo)
{
    EXPECT_EQ(compare("run@99", "run").code, 2);
    EXPECT_EQ(compare("run@soon", "run").code, 2);
    EXPECT_EQ(compare("run", "nowhere").code, 2);
    EXPECT_EQ(compare("run", "nowhere@1").code, 2);
    std::filesystem::copy(path("run"), path("a@b"), std::filesystem::copy_options::recursive);
    EXPECT_EQ(compare("run", "a@b").code, 0) << "a folder's own name";
    std::filesystem::remove(path("run/timing.json"));
    EXPECT_THAT(compare("run", "a@b@first").out, HasSubstr("-")) << "only seconds are lost";
}

TEST_F(CompareTest, FalseColoursHaveALegendAndAFixedRange)
{
    for (const std::vector<std::string>& how : {std::vector<std::string>{"--false-color", "lux", "--isolines", "5"},
                                                {"--false-color", "radiosity"},
                                                {"--false-color", "irradiance", "--range", "0.1:10", "--scale", "log"},
                                                {"--show", "error", "--wireframe"},
                                                {"--show", "size", "--scale", "linear"}}) {
        std::vector<std::string> words{"render", path("run"), "-o", path("a.png"), "--size", "64x48"};
        words.insert(words.end(), how.begin(), how.end());
        const Outcome outcome = run(words);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Image image = read_image(path("a.png")).image;
        EXPECT_EQ(image.width, 64);
        EXPECT_GT(image.height, 48) << "the legend stands below";
    }
    const auto fixed = [&](const std::string& cycle, const std::string& file) {
        EXPECT_EQ(run({"render", path("run"), "-o", path(file), "--size", "32x24", "--false-color", "lux", "--range",
                       "0:100", "--cycle", cycle})
                      .code,
                  0);
        const Image image = read_image(path(file)).image;
        return std::vector<float>(image.rgb.end() - 32 * 3 * 20, image.rgb.end());
    };
    EXPECT_EQ(fixed("first", "b.png"), fixed("last", "c.png")) << "one range, one legend";
}

TEST_F(CompareTest, CyclesShotsAndPathsAreAnimated)
{
    const std::string cycles = nlohmann::json::parse(text_of(path("run/run.json")))["cycles"].size() > 1 ? "ok" : "";
    ASSERT_EQ(cycles, "ok");
    ASSERT_EQ(run({"animate", path("run"), "-o", path("new/a.png"), "--size", "24x24", "--wireframe"}).code, 0);
    EXPECT_THAT(text_of(path("new/a.png")), HasSubstr("acTL"));
    ASSERT_EQ(run({"animate", path("run"), "-o", path("b.png"), "--size", "24x24", "--wireframe"}).code, 0);
    EXPECT_EQ(text_of(path("new/a.png")), text_of(path("b.png"))) << "same run, same bytes";
    ASSERT_EQ(run({"animate", path("run@first"), "-o", path("one"), "--size", "24x24"}).code, 0);
    EXPECT_EQ(files_in(path("one")).size(), 1U);
    ASSERT_EQ(run({"animate", path("run"), "-o", path("shots"), "--what", "shots"}).code, 0);
    EXPECT_EQ(files_in(path("shots")).size(), 2U);

    write_text(path("path.json"), std::string("[") + view_text + ", {\"from\": [0.9, 0.6, 2], \"to\": [0.5, 0.4, 0]}]");
    const auto fly = [&](const std::string& frames) {
        return run({"animate", path("run"), "-o", path("frames"), "--what", "path", "--path", path("path.json"),
                    "--frames", frames, "--size", "16x16"});
    };
    ASSERT_EQ(fly("5").code, 0);
    EXPECT_EQ(files_in(path("frames")).size(), 5U);
    ASSERT_EQ(fly("3").code, 0);
    EXPECT_EQ(files_in(path("frames")).size(), 3U) << "no frame of the longer one is left";
    write_text(path("frames/notes.txt"), "mine");
    EXPECT_EQ(fly("3").code, 2);
    write_text(path("path.json"), view_text);
    EXPECT_THAT(fly("3").err, HasSubstr("two cameras"));
}

TEST_F(CompareTest, WithoutPicturesOfShotsItSaysHowToGetThem)
{
    ASSERT_EQ(run(small({"solve", write_scene(), "-o", path("plain"), "--quiet"})).code, 0);
    const Outcome outcome = run({"animate", path("plain"), "-o", path("a.png"), "--what", "shots"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("--snapshots 1,2,3,16"));
    std::filesystem::remove(path("run/shots-02.png"));
    EXPECT_EQ(run({"animate", path("run"), "-o", path("a.png"), "--what", "shots"}).code, 2);
}

}  // namespace
}  // namespace patchlight::testing
