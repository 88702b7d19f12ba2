#include "apps/report/study_page.h"
#include "apps/run/run_options.h"
#include "tests/study/made_study.h"

#include <gmock/gmock.h>

#include <cstdlib>

namespace patchlight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Without a folder: its cells have no runs to tell of.
const StudyFolder nowhere{"/nonexistent/study"};

Json description_in(const std::string& page)
{
    const std::string begin = "<script type=\"application/json\" id=\"description\">";
    const std::size_t at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(StudyPageTest, HoldsTheTableAndThePictures)
{
    const ShownStudy study{testing::made_study(), "abc", 7, {{1, "front", "not really a PNG"}}};
    const std::string page = study_page(study, nowhere);
    EXPECT_THAT(page, AllOf(StartsWith("<!doctype html>"), HasSubstr("default-src 'none'; script-src 'sha256-"),
                            HasSubstr("<title>made – Patchlight report</title>"), Not(HasSubstr("id=\"payload\""))));
    EXPECT_EQ(study_page(study, nowhere), page);
    const Json description = description_in(page);
    EXPECT_EQ(description["study_sha256"], "abc");
    EXPECT_EQ(description["table"]["cells"].size(), 8U);
    EXPECT_EQ(description["table"]["cells"][0]["origin"], nullptr);
    EXPECT_EQ(description["pictures"][0]["png"], "bm90IHJlYWxseSBhIFBORw==");
}

TEST(StudyPageTest, NamesCannotBecomeMarkup)
{
    ShownStudy study{testing::made_study(), "", 1, {}};
    study.result.name = "</title><script>alert(1)</script>";
    study.result.cells[0].message = "<!-- <script>";
    const std::string page = study_page(study, nowhere);
    EXPECT_THAT(page, AllOf(Not(HasSubstr("<script>alert")), Not(HasSubstr("<!-- <script>")),
                            HasSubstr("&lt;script&gt;alert(1)"), HasSubstr("\\u003c!-- \\u003cscript\\u003e")));
}

TEST(StudyPageTest, SecondsAreLeftOutWhereThePageIsToBeReproducible)
{
    ShownStudy study{testing::made_study(), "", 1, {}}, later = study;
    for (CellResult& cell : later.result.cells)
        for (CycleResult& cycle : cell.cycles) cycle.seconds *= 3;
    ASSERT_EQ(std::getenv("SOURCE_DATE_EPOCH"), nullptr);
    EXPECT_NE(study_page(study, nowhere), study_page(later, nowhere));
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    EXPECT_EQ(study_page(study, nowhere), study_page(later, nowhere));
    unsetenv("SOURCE_DATE_EPOCH");
}

TEST(StudyPageTest, AStudyWithNothingInItHasAPage)
{
    EXPECT_THAT(study_page({}, nowhere), HasSubstr("\"cells\":[]"));
}

}  // namespace
}  // namespace patchlight
