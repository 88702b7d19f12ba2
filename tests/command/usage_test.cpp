#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Each kind once through the program; arguments_test tries many more.
class UsageTest : public CommandTest {};

TEST_F(UsageTest, EndsWithTwoAndAMessageBeforeAnyFileIsLookedAt)
{
    for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                  {"verify"},
                                                  {"solve", "room.obj"},
                                                  {"solve", "room.obj", "-o", "run", "--threads", "1e9"},
                                                  {"solve", "room.obj", "-o", "run", "--refine", "lines"}}) {
        const Outcome outcome = run(words, {.folder = folder_});
        EXPECT_EQ(outcome.code, 2);
        EXPECT_THAT(outcome.err, StartsWith("error[usage]: "));
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(files_in(folder_).size(), 2U) << "only what the test itself wrote down";
    }
}

TEST_F(UsageTest, HelpShowsEveryDefault)
{
    const Outcome help = run({"solve", "--help"});
    EXPECT_EQ(help.code, 0);
    for (const char* shown : {"--refine", "[both]", "--direct", "[exact]", "--solver", "[gauss-seidel]", "[hemisphere]",
                              "[8000]", "[residual]", "[doerfler]", "[0.95]", "[0.0001]", "--unit", "[m]"}) {
        EXPECT_THAT(help.out, HasSubstr(shown));
    }
}

TEST_F(UsageTest, EveryOptionOfEveryCommandTellsWhatIsDoneWithoutIt)
{
    for (const char* command :
         {"demo", "inspect", "solve", "render", "compare", "animate", "probe", "verify", "export", "report",
          "formfactors", "validate", "study check", "study run", "study cell", "study table", "study report"}) {
        // An option's lines: its name and value, and indented its text, which ends with what is done without it.
        const std::string help = run(words_of(std::string(command) + " --help")).out;
        std::istringstream lines(help.substr(help.find("\nOptions:\n") + 10));
        std::string option;
        const auto check = [&] {
            EXPECT_TRUE(option.empty() || option.starts_with("  -h") || option.find('[') != std::string::npos ||
                        option.find("(required)") != std::string::npos)
                << command << ": " << option;
        };
        for (std::string line; std::getline(lines, line) && !line.empty();) {
            if (line.starts_with("  -")) {
                check();
                option.clear();
            }
            option += line + "\n";
        }
        EXPECT_NE(option, "");
        check();
    }
}

TEST_F(UsageTest, HelpNamesNothingThatDoesNotExist)
{
    for (const char* command :
         {"demo", "inspect", "solve", "render", "compare", "animate", "probe", "verify", "export", "report", "study"}) {
        const Outcome help = run({command, "--help"});
        EXPECT_EQ(help.code, 0);
        EXPECT_EQ(help.err, "");
        for (const char* absent : {"rerun"}) {
            EXPECT_THAT(help.out, Not(HasSubstr(absent))) << command;
        }
    }
    EXPECT_THAT(run({"--help"}).out, HasSubstr("demo"));
    EXPECT_THAT(run({"--version"}).out, StartsWith("patchlight 0."));
}

TEST_F(UsageTest, CamerasAreCheckedToo)
{
    const std::string scene = write_scene();
    EXPECT_THAT(run(small({"solve", scene, "-o", path("run"), "--view", "back"})).err,
                HasSubstr("the scene has front"));
    write_text(path("bad.json"), "{\"from\": [0,0,0], \"to\": [0,0,1], \"fow\": 40}");
    const Outcome typo = run(small({"solve", scene, "-o", path("run"), "--view", path("bad.json")}));
    EXPECT_EQ(typo.code, 2);
    EXPECT_THAT(typo.err, HasSubstr("unknown key \"fow\""));
    write_text(path("room.view.json"), "{\"from\": ");
    EXPECT_EQ(run(small({"solve", scene, "-o", path("run")})).code, 2);
}

TEST_F(UsageTest, MoreThanTheMachineHoldsIsRefusedBeforeItIsAllocated)
{
    const Outcome outcome = run({"solve", write_scene(), "-o", path("run"), "--max-elements", "1000000000"});
    EXPECT_EQ(outcome.code, 5);
    EXPECT_THAT(outcome.err, HasSubstr("error[memory]: needs "));
    EXPECT_EQ(run({"solve", write_scene(), "-o", path("run"), "--refine", "none", "--max-edge", "1e-6"}).code, 5);
    EXPECT_FALSE(std::filesystem::exists(path("run")));
}

}  // namespace
}  // namespace patchlight::testing
