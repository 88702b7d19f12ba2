#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Tables and pages of studies that were run, and of such that weren't.
class StudyTableTest : public CommandTest {
protected:
    /// Two cells of a tenth of a second each.
    void write_study(const std::string& more = "")
    {
        write_scene();
        write_text(folder_ / "small.toml",
                   "title = \"small\"\nscene = \"room.obj\"\n[options]\nmax_edge = 0.5\nrays = 32\n"
                   "vertex_rays = 16\nrefine = \"intensity\"\n[vary]\nmax_elements = [100, 220]\n"
                   "[reference]\nkind = \"none\"\n[pictures]\nsize = \"32x32\"\n" +
                       more);
    }

    Outcome study(std::vector<std::string> words, const Surroundings& around = {})
    {
        words.insert(words.begin(), "study");
        words.insert(words.begin() + 2, path("small.toml"));
        return run(words, around);
    }
};

TEST_F(StudyTableTest, OfAStudyThatWasNotRunWaitsInAllNotations)
{
    write_study();
    const Outcome table = study({"table", "-o", path("s")});
    ASSERT_EQ(table.code, 0) << table.err;
    EXPECT_THAT(table.out, AllOf(StartsWith("# small\n"), HasSubstr("waiting")));
    EXPECT_THAT(study({"table", "-o", path("s"), "--format", "csv"}).out, StartsWith("cell,max-elements,cycles,"));
    EXPECT_THAT(study({"table", "-o", path("s"), "--format", "tex"}).out, HasSubstr("\\toprule"));
    EXPECT_EQ(nlohmann::json::parse(study({"table", "-o", path("s"), "--format", "json"}).out)["cells"].size(), 2U);
    EXPECT_FALSE(std::filesystem::exists(path("s"))) << "a table writes nothing";
    EXPECT_EQ(study({"table", "--format", "xls"}).code, 2);
    EXPECT_EQ(study({"report", "-o", path("page.pdf")}).code, 2);
    const Outcome page = study({"report", "--dir", path("s"), "-o", path("page.html"), "--json"});
    ASSERT_EQ(page.code, 0) << page.err;
    EXPECT_EQ(nlohmann::json::parse(page.out)["pictures"], 0);
    EXPECT_FALSE(std::filesystem::exists(path("s")));
}

TEST_F(StudyTableTest, StoredTablesAreWhatTheCommandPrints)
{
    write_study();
    const Outcome ran = study({"run", "-o", path("s"), "--quiet"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(study({"table", "-o", path("s")}).out, text_of(folder_ / "s/table.md"));
    EXPECT_EQ(study({"table", "-o", path("s"), "--format", "csv"}).out, text_of(folder_ / "s/table.csv"));
    EXPECT_THAT(text_of(folder_ / "s/table.md"), AllOf(HasSubstr("done"), Not(HasSubstr("seconds"))));
    EXPECT_THAT(study({"table", "-o", path("s"), "--seconds"}).out, HasSubstr("seconds"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "s/pictures/000-view.png"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "s/pictures/001-view.png"));
}

TEST_F(StudyTableTest, PagesNeedOnlyTheFolderAndLeaveOutSecondsWhenAsked)
{
    write_study();
    ASSERT_EQ(study({"run", "-o", path("s"), "--quiet"}).code, 0);
    const Surroundings around{.environment = {{"SOURCE_DATE_EPOCH", "0"}}};
    ASSERT_EQ(study({"report", "--dir", path("s"), "-o", path("a.html")}, around).code, 0);
    const auto pictures = files_in(folder_ / "s/pictures");
    std::filesystem::rename(folder_ / "small.toml", folder_ / "gone.toml");
    const Outcome page = run({"report", path("s"), "-o", path("b.html"), "--json"}, around);
    ASSERT_EQ(page.code, 0) << page.err;
    EXPECT_EQ(nlohmann::json::parse(page.out)["pictures"], 2);
    EXPECT_EQ(text_of(folder_ / "a.html"), text_of(folder_ / "b.html"));
    EXPECT_THAT(text_of(folder_ / "a.html"), Not(HasSubstr("\"seconds\":")));
    EXPECT_EQ(files_in(folder_ / "s/pictures"), pictures) << "the same bytes from study run and study report";
    write_text(folder_ / "s/study.json", "{\"study\": 7}");
    const Outcome broken = run({"report", path("s"), "-o", path("c.html")});
    EXPECT_EQ(broken.code, 3);
    EXPECT_THAT(broken.err, HasSubstr("study.json"));
}

TEST_F(StudyTableTest, GatesThatFailEndWithFourAndAreNamed)
{
    write_study("[gates]\nmax_energy_residual = 1e-30\n");
    const Outcome ran = study({"run", "-o", path("s"), "--quiet"});
    EXPECT_EQ(ran.code, 4);
    EXPECT_THAT(ran.err, AllOf(HasSubstr("error[gate]: max_energy_residual of max-elements=100: "),
                               HasSubstr("max_energy_residual of max-elements=220: ")));
    EXPECT_THAT(text_of(folder_ / "s/table.md"), HasSubstr("0 of 2 passed."));
}

TEST_F(StudyTableTest, VerifyHoldsAllRunsFilesAgainstTheirDigests)
{
    write_study();
    ASSERT_EQ(study({"run", "-o", path("s"), "--quiet"}).code, 0);
    const Outcome whole = run({"verify", path("s")});
    ASSERT_EQ(whole.code, 0) << whole.err;
    EXPECT_THAT(whole.out, HasSubstr("of 2 runs are what was written"));
    const Outcome traced = run({"verify", path("s"), "--points", "20", "--paths", "8", "--quiet"});
    EXPECT_EQ(traced.code, 0) << traced.err;
    EXPECT_THAT(traced.out, HasSubstr("relative L2"));
    EXPECT_EQ(run({"verify", path("s"), "--points", "20", "--json"}).code, 2);
    for (const auto& cell : std::filesystem::directory_iterator(folder_ / "s/cells")) {
        write_text(cell.path() / "run/solution.glb", "glTF");
        break;
    }
    const Outcome changed = run({"verify", path("s"), "--json"});
    EXPECT_EQ(changed.code, 3);
    EXPECT_THAT(changed.err, HasSubstr("solution.glb"));
    EXPECT_EQ(nlohmann::json::parse(changed.out)["problems"].size(), 1U);
}

}  // namespace
}  // namespace patchlight::testing
