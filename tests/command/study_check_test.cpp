#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

class StudyCheckTest : public CommandTest {
protected:
    Outcome check(const std::string& study, const std::vector<std::string>& more = {})
    {
        write_text(path("study.toml"), study);
        std::vector<std::string> words{"study", "check", "study.toml"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words, {.folder = folder_});
    }
};

const std::string room = "scene = \"room.obj\"\n";

TEST_F(StudyCheckTest, ShowsEveryCellAndWhatTheStudyNeedsAndWritesNothing)
{
    write_scene();
    const std::string study = room + "[vary]\nrefine = [\"none\", \"both\"]\nmax_elements = [100, 200, 400]\n"
                                     "[[skip]]\nrefine = \"none\"\nmax_elements = 400\n[gates]\nmin_rate = 0.5\n";
    write_text(path("study.toml"), study);
    const auto listing = [&] {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
            if (entry.path().parent_path().filename() != "scratch") found.push_back(entry.path().string());
        std::ranges::sort(found);
        return found;
    };
    const auto before = listing();
    const auto bytes = text_of(folder_ / "study.toml");
    const Outcome table = check(study);
    EXPECT_EQ(table.code, 0) << table.err;
    EXPECT_EQ(table.err, "");
    EXPECT_EQ(listing(), before);
    EXPECT_EQ(text_of(folder_ / "study.toml"), bytes);
    for (const char* said : {"cells      5 of 2 refine x 3 max-elements, 1 skipped\n", "along      max-elements\n",
                             "reference  path-traced, points 2000, paths 4096\n", "gates      min_rate 0.5\n",
                             "cell  refine  max-elements  elements", "   5    both           400       400"})
        EXPECT_THAT(table.out, HasSubstr(said));
    EXPECT_THAT(table.out, Not(HasSubstr("   2    none"))) << "skipped";

    const Outcome json = check(study, {"--json", "--jobs", "2"});
    EXPECT_EQ(listing(), before);
    const auto j = nlohmann::json::parse(json.out);
    EXPECT_EQ(j["schema"], "patchlight-study-check/1");
    EXPECT_EQ(j["grid"], 6);
    ASSERT_EQ(j["cells"].size(), 5U);
    EXPECT_EQ(j["cells"][2]["name"], "refine=both max-elements=100");
    EXPECT_EQ(j["cells"][2]["options"]["refine"], "both");
    EXPECT_EQ(j["cells"][2]["options"]["pictures"], "none");
    EXPECT_EQ(j["cells"][4]["cost"]["elements"], 400);
    // Two at a time: the two that need most.
    EXPECT_EQ(j["total"]["bytes"].get<double>(),
              j["cells"][4]["cost"]["bytes"].get<double>() +
                  std::max(j["cells"][1]["cost"]["bytes"].get<double>(), j["cells"][3]["cost"]["bytes"].get<double>()));
    EXPECT_EQ(check(study, {"--json", "--jobs", "2"}).out, json.out);
}

TEST_F(StudyCheckTest, OnlyTheFirstFiftyCellsAreShown)
{
    write_scene();
    std::string study = room + "[vary]\nseed = [1";
    for (int i = 2; i <= 60; ++i) study += ", " + std::to_string(i);
    const Outcome table = check(study + "]\n");
    EXPECT_EQ(table.code, 0);
    EXPECT_THAT(table.out, HasSubstr("\n... and 10 more\n"));
    EXPECT_THAT(table.out, HasSubstr("\n  49    50 "));
    EXPECT_THAT(table.out, Not(HasSubstr("\n  50    51 ")));
}

TEST_F(StudyCheckTest, RefusesWhatCannotBeMeantWithThePlace)
{
    write_scene();
    const Outcome typo = check(room + "[vary]\nmax_egde = [1, 2]\n");
    EXPECT_EQ(typo.code, 2);
    EXPECT_EQ(typo.out, "");
    EXPECT_EQ(typo.err, "error[study]: study.toml:3:1: unknown key \"max_egde\", did you mean \"max_edge\"?\n");
    const Outcome value = check(room + "[vary]\nrays = [64, 3]\n");
    EXPECT_EQ(value.code, 2);
    EXPECT_THAT(value.err, StartsWith("error[usage]: study.toml:3:13: --rays: \"3\" is not"));
    EXPECT_THAT(value.err, HasSubstr("(cell rays=3)"));
    EXPECT_THAT(check(room + "[limits]\nmemory = \"much\"\n").err, HasSubstr("study.toml:3:10: --memory"));
    EXPECT_EQ(check(room + "[reference]\nkind = \"run\"\nrun = \"none\"\n").code, 2);
    EXPECT_EQ(check(room + "[reference]\nkind = \"points\"\nfile = \"none.csv\"\n").code, 2);
    EXPECT_EQ(check(room + "[metrics]\nprobes = \"none.csv\"\n").code, 2);
    EXPECT_THAT(check(room + "[pictures]\nviews = [\"back\"]\n").err, HasSubstr("the scene has front"));
    EXPECT_THAT(check(room + "[reference]\nkind = \"solution\"\n[reference.options]\nrays = 3\n").err,
                HasSubstr("study.toml:5:1: --rays"));
    EXPECT_THAT(check(room + "[options]\nmesh = \"none\"\n").err, HasSubstr("none"));
    EXPECT_EQ(run({"study", "check", path("missing.toml")}).code, 2);
    EXPECT_THAT(run({"study", "check", path("missing.toml")}).err, HasSubstr("missing.toml: No such file"));
    EXPECT_THAT(run({"study", "check", folder_.string()}).err, HasSubstr("Is a directory"));
    EXPECT_THAT(run({"study", "check", "/dev/zero"}).err, HasSubstr("too many"));
}

TEST_F(StudyCheckTest, BadScenesAndLimitsHaveTheirOwnCodes)
{
    write_scene();
    EXPECT_EQ(check("scene = \"missing.obj\"\n").code, 3);
    const Outcome memory = check(room + "[vary]\nmax_elements = [100, 1000000]\n[limits]\nmemory = \"100MB\"\n");
    EXPECT_EQ(memory.code, 5);
    EXPECT_THAT(memory.err, HasSubstr("(cell max-elements=1000000)"));
    std::string study = room + "[vary]\n";
    for (const char* name : {"rays", "max_elements", "seed"}) {
        study += std::string(name) + " = [16";
        for (int i = 17; i < 1016; ++i) study += ", " + std::to_string(i);
        study += "]\n";
    }
    const Outcome grid = check(study);
    EXPECT_EQ(grid.code, 5);
    EXPECT_THAT(grid.err, StartsWith("error[study]: study.toml: 1000000000 cells, limit 1000"));
}

TEST_F(StudyCheckTest, GroupsNameTheirCommands)
{
    EXPECT_EQ(run({"study"}).code, 2);
    EXPECT_THAT(run({"study", "chek"}).err, HasSubstr("there is no command \"study chek\"; there are check"));
    EXPECT_THAT(run({"study", "--help"}).out, HasSubstr("\nUsage: patchlight study COMMAND"));
    EXPECT_THAT(run({"study", "check", "--help"}).out, HasSubstr("\nUsage: patchlight study check STUDY [OPTIONS]\n"));
}

/// Options from a file.
class ConfigurationTest : public CommandTest {
protected:
    std::string record(const std::vector<std::string>& words, const std::string& folder)
    {
        std::vector<std::string> all{"solve", write_scene(), "-o", path(folder), "--pictures", "none"};
        all.insert(all.end(), words.begin(), words.end());
        const Outcome outcome = run(all);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return text_of(folder_ / folder / "run.json");
    }
};

TEST_F(ConfigurationTest, GivesTheSameRecordAsTheSameFlags)
{
    write_text(path("c.toml"), "refine = \"none\"\nmax_elements = 150\nrays = 32\nvertex_rays = 16\n"
                               "emitter = [\"lamp=20,9,8\"]\nseed = 5\nthreads = 1\n");
    const std::string flags = record({"--refine", "none", "--max-elements", "150", "--rays", "32", "--vertex-rays",
                                      "16", "--emitter", "lamp=20,9,8", "--seed", "5"},
                                     "a");
    EXPECT_EQ(record({"--config", path("c.toml")}, "b"), flags);
    EXPECT_NE(record({"--config", path("c.toml"), "--seed", "6"}, "c"), flags);
}

TEST_F(ConfigurationTest, TheCommandLineWins)
{
    write_text(path("c.toml"), "refine = \"both\"\nmax_elements = 150\nrays = 32\nvertex_rays = 16\nseed = 5\n");
    const std::string flags = record(
        {"--refine", "none", "--max-elements", "120", "--rays", "32", "--vertex-rays", "16", "--seed", "5"}, "a");
    EXPECT_EQ(record({"--refine", "none", "--config", path("c.toml"), "--max-elements", "120"}, "b"), flags);
    // A given mesh has no other refinement: what the file says about one is not asked for.
    write_text(path("d.toml"), "refine = \"both\"\nrays = 32\nvertex_rays = 16\n");
    const auto mesh = nlohmann::json::parse(record({"--mesh", path("a"), "--config", path("d.toml")}, "c"));
    EXPECT_EQ(mesh["options"]["solve"]["refine"], "none");
}

TEST_F(ConfigurationTest, BadOnesAreRefusedWithThePlace)
{
    const std::string scene = write_scene();
    const auto refusal = [&](const std::string& text) {
        write_text(path("c.toml"), text);
        const Outcome outcome = run({"solve", scene, "-o", "run", "--config", "c.toml"}, {.folder = folder_});
        EXPECT_EQ(outcome.code, 2);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "run"));
        return outcome.err;
    };
    EXPECT_EQ(refusal("\nmax_egde = 1\n"),
              "error[configuration]: c.toml:2:1: unknown key \"max_egde\", did you mean \"max_edge\"?\n");
    EXPECT_THAT(refusal("rays = 3\n"), StartsWith("error[usage]: c.toml:1:1: --rays: "));
    EXPECT_THAT(refusal("config = \"c.toml\"\n"), HasSubstr("unknown key \"config\""));
    EXPECT_THAT(refusal("rays = \n"), HasSubstr("c.toml:1:"));
    EXPECT_THAT(refusal("o = \"elsewhere\"\n"), HasSubstr("given on the command line"));
    EXPECT_THAT(run({"solve", scene, "-o", path("run"), "--config", path("none.toml")}).err,
                HasSubstr("none.toml: No such file"));
}

}  // namespace
}  // namespace patchlight::testing
