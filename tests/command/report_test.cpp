#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// report on a small run; what a browser makes of it is tests/report's.
class ReportTest : public CommandTest {
protected:
    void solve(const std::string& scene, std::vector<std::string> options = {})
    {
        options.insert(options.begin(), {"solve", scene, "-o", path("run"), "--quiet"});
        const Outcome outcome = run(small(options));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
};

TEST_F(ReportTest, WritesOnePageThatNamesNothingElsewhere)
{
    solve(write_scene());
    const Outcome outcome = run({"report", path("run"), "-o", path("new/page.html")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "wrote   " + path("new/page.html") + "\n");
    const std::string page = text_of(folder_ / "new/page.html");
    EXPECT_THAT(page,
                AllOf(StartsWith("<!doctype html>"), HasSubstr("content=\"default-src 'none'; script-src 'sha256-"),
                      HasSubstr("room.obj – Patchlight report")));
    for (const char* loading : {" src=", "@import", "url(", "<link rel=\"stylesheet\"", " onclick", " style="}) {
        EXPECT_THAT(page.substr(0, page.find("<script type=\"application/json\"")), Not(HasSubstr(loading)));
    }
    ASSERT_EQ(run({"report", path("run"), "-o", path("again.html")}).code, 0);
    EXPECT_EQ(text_of(folder_ / "again.html"), page) << "byte for byte";
}

TEST_F(ReportTest, TwoRunsOfOneSceneGiveOnePageWhereItIsToBeReproducible)
{
    const std::string scene = write_scene();
    solve(scene);
    ASSERT_EQ(run(small({"solve", scene, "-o", path("run2"), "--quiet", "--threads", "1"})).code, 0);
    const Surroundings around{.environment = {{"SOURCE_DATE_EPOCH", "0"}}};
    ASSERT_EQ(run({"report", path("run"), "-o", path("a.html")}, around).code, 0);
    ASSERT_EQ(run({"report", path("run2"), "-o", path("b.html")}, around).code, 0);
    EXPECT_EQ(text_of(folder_ / "a.html"), text_of(folder_ / "b.html"));
}

TEST_F(ReportTest, NamesCannotBecomeMarkup)
{
    std::string scene = scene_text, materials = material_text;
    for (std::string* text : {&scene, &materials}) {
        for (std::size_t at = 0; (at = text->find("mtl red", at)) != std::string::npos; ++at) {
            text->replace(at, 7, "mtl </script><script>alert(1)</script>");
        }
    }
    const std::string file = write_scene("<i>room.obj");
    write_text(file, scene);
    write_text(folder_ / "room.mtl", materials);
    solve(file);
    ASSERT_EQ(run({"report", path("run"), "-o", path("page.html")}).code, 0);
    const std::string page = text_of(folder_ / "page.html");
    EXPECT_THAT(page, AllOf(Not(HasSubstr("<script>alert")), HasSubstr("\\u003cscript\\u003ealert(1)"),
                            Not(HasSubstr("<i>room")), HasSubstr("&lt;i&gt;room.obj")));
}

TEST_F(ReportTest, TellsInJsonWhatIsInIt)
{
    solve(write_scene(), {"--snapshots", "1,4"});
    EXPECT_TRUE(std::filesystem::exists(folder_ / "run/shots-01.glb"));
    const Outcome outcome = run({"report", path("run"), "-o", path("page.html"), "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto told = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(told["file"], path("page.html"));
    EXPECT_EQ(told["bytes"], std::filesystem::file_size(folder_ / "page.html"));
    EXPECT_EQ(told["cycles"].front(), 0);
    EXPECT_THAT(text_of(folder_ / "page.html"), AllOf(HasSubstr("\"shots\":1,"), HasSubstr("\"shots\":4,")));
}

TEST_F(ReportTest, BrokenOrMissingPartsAreNamed)
{
    EXPECT_EQ(run({"report", path("nothing"), "-o", path("a.html")}).code, 2);
    EXPECT_EQ(run({"report", path("run"), "-o", path("a.pdf")}).code, 2);
    solve(write_scene(), {"--snapshots", "1"});
    // Of no use to the page without seconds, but not in its way.
    write_text(folder_ / "run/timing.json", "{");
    EXPECT_EQ(run({"report", path("run"), "-o", path("a.html")}).code, 0);
    EXPECT_EQ(run({"report", path("run"), "-o", path("run/run.json/a.html")}).code, 6);
    write_text(folder_ / "run/shots-01.glb", "glTF");
    const Outcome snapshot = run({"report", path("run"), "-o", path("b.html")});
    EXPECT_EQ(snapshot.code, 3);
    EXPECT_THAT(snapshot.err, HasSubstr("shots-01.glb"));
    std::filesystem::remove(folder_ / "run/shots-01.glb");
    std::filesystem::remove(folder_ / "run/cycles/00/solution.glb");
    EXPECT_EQ(run({"report", path("run"), "-o", path("b.html")}).code, 3);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.html"));
}

TEST_F(ReportTest, WithoutAProgramToOpenItThePageIsStillThere)
{
    solve(write_scene());
    const Outcome outcome =
        run({"report", path("run"), "-o", path("a.html"), "--open"}, {.environment = {{"PATH", path("scratch")}}});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("open it in a browser"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.html"));
}

}  // namespace
}  // namespace patchlight::testing
