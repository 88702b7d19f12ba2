#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;

class DemoTest : public CommandTest {};

TEST_F(DemoTest, NeedsNothingBesideTheProgramAndCanBeRunAgain)
{
    const Outcome outcome = run({"demo"}, {.folder = folder_});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part : {"elements", "estimated error", "seconds", "patchlight-demo/compare.png",
                             "wrote   patchlight-demo/report.html"}) {
        EXPECT_THAT(outcome.out, HasSubstr(part));
    }
    const std::filesystem::path demo = folder_ / "patchlight-demo";
    EXPECT_EQ(text_of(demo / "scene/cornell-box.obj"), text_of(PATCHLIGHT_DATA "/scenes/cornell-box.obj"));
    const auto files = files_in(demo);
    EXPECT_LE(files.at("report.html").size(), 3'000'000U) << "opens at once, and can be sent by mail";
    EXPECT_EQ(run({"demo"}, {.folder = folder_}).code, 0);
    EXPECT_EQ(files_in(demo), files);

    // A demo that another version left: with other options, so it makes room.
    std::string record = text_of(demo / "run.json");
    const std::string option = "\"max_elements\": 8000";
    record.replace(record.find(option), option.size(), "\"max_elements\": 7000");
    write_text(demo / "run.json", record);
    EXPECT_EQ(run({"demo", "--quiet"}, {.folder = folder_}).code, 0);
    EXPECT_EQ(lasting_files_in(demo).at("solution.glb"), files.at("solution.glb"));
}

TEST_F(DemoTest, AForeignFolderIsLeftAlone)
{
    std::filesystem::create_directory(folder_ / "mine");
    write_text(folder_ / "mine/letter.txt", "dear");
    const Outcome outcome = run({"demo", "-o", path("mine")});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("error[folder]"));
    EXPECT_EQ(files_in(folder_ / "mine").size(), 1U);
}

}  // namespace
}  // namespace patchlight::testing
