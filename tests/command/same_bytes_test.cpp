#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

namespace patchlight::testing {
namespace {

/// The same scene and options give the same files, whatever is around.
class SameBytesTest : public CommandTest {
protected:
    void solve_into(const std::string& run_folder, std::vector<std::string> more = {}, const Surroundings& around = {})
    {
        std::vector<std::string> words{"solve", write_scene(), "-o", path(run_folder), "--snapshots", "1,2"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = run(small(words), around);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    void expect_same(const std::string& a, const std::string& b)
    {
        const auto left = lasting_files_in(folder_ / a), right = lasting_files_in(folder_ / b);
        ASSERT_EQ(left.size(), right.size());
        EXPECT_GT(left.size(), 8U);
        for (const auto& [name, bytes] : left) {
            EXPECT_TRUE(right.at(name) == bytes) << name << " differs";
        }
    }
};

TEST_F(SameBytesTest, WithOneThreadAndWithTwo)
{
    solve_into("one", {"--threads", "1"});
    solve_into("two", {"--threads", "2"});
    expect_same("one", "two");
}

TEST_F(SameBytesTest, TheCornellBoxWithOneThreadAndWithTwo)
{
    // Blocks that hide the light from many patches: more ways through the code than the small room has.
    for (const char* threads : {"1", "2"}) {
        const Outcome outcome = run({"solve", PATCHLIGHT_DATA "/scenes/cornell-box.obj", "-o", path(threads), "--unit",
                                     "mm", "--max-elements", "1500", "--size", "40x40", "--threads", threads});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    expect_same("1", "2");
}

TEST_F(SameBytesTest, FromAnotherFolderAndOnATerminalWithoutColours)
{
    solve_into("here");
    solve_into("there", {}, {.environment = {{"NO_COLOR", "1"}, {"TERM", "dumb"}}, .folder = "/"});
    expect_same("here", "there");
}

TEST_F(SameBytesTest, WhereTheDecimalPointIsAComma)
{
    const std::string locales = path("locales");
    std::filesystem::create_directory(locales);
    const std::string make = "localedef -i de_DE -f UTF-8 --no-archive " + locales + "/de_DE.UTF-8 > /dev/null 2>&1";
    ASSERT_EQ(std::system(make.c_str()), 0) << "needs the Debian package locales";
    const Surroundings german{
        .environment = {{"LOCPATH", locales}, {"LC_ALL", "de_DE.UTF-8"}, {"LANG", "de_DE.UTF-8"}}};
    solve_into("point");
    solve_into("comma", {}, german);
    expect_same("point", "comma");
    write_text(path("points.csv"), "0.25,0,0.75\n");
    const std::vector<std::string> probe{"probe", path("comma"), "--points", path("points.csv")};
    EXPECT_EQ(run(probe).out, run(probe, german).out);
}

TEST_F(SameBytesTest, PathsWithSpacesAndOtherLettersAndALeadingDash)
{
    write_scene();
    for (const char* name : {"a room.obj", "größe-部屋.obj", "-x.obj"}) {
        write_scene(name);
    }
    const std::vector<std::vector<std::string>> spellings{{"a room.obj"}, {"größe-部屋.obj"}, {"./-x.obj"}};
    int number = 0;
    for (const auto& scene : spellings) {
        std::vector<std::string> words{"solve", "-o", "räume und " + std::to_string(number++), "--pictures", "none"};
        words.insert(words.end(), scene.begin(), scene.end());
        EXPECT_EQ(run(small(words), {.folder = folder_}).code, 0) << scene[0];
    }
    EXPECT_EQ(run({"inspect", "--", "-x.obj"}, {.folder = folder_}).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "räume und 1" / "solution.glb"));
    EXPECT_THAT(text_of(folder_ / "räume und 1" / "run.json"), ::testing::HasSubstr("größe-部屋.obj"));
}

}  // namespace
}  // namespace patchlight::testing
