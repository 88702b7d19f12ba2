#include "apps/report/page_files.h"
#include "apps/report/report_data.h"
#include "apps/report/report_payload.h"
#include "apps/run/markup_text.h"

#include <gmock/gmock.h>

#include <cstring>

namespace patchlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ReportPayloadTest, Base64IsThatOfTheStandard)
{
    // RFC 4648, section 10.
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(ReportPayloadTest, TextCannotBecomeMarkup)
{
    EXPECT_EQ(markup_text("<b title=\"x\">'&'</b>"), "&lt;b title=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/b&gt;");
    const Json hostile = {{"</script><script>alert(1)</script>", "<!--\xe2\x80\xa8&"}};
    const std::string text = script_json(hostile);
    for (const char* bad : {"<", ">", "&", "\xe2\x80\xa8"}) EXPECT_THAT(text, Not(HasSubstr(bad)));
    EXPECT_EQ(Json::parse(text), hostile) << "escaped, not changed";
}

TEST(ReportPayloadTest, ArraysStandWhereItSays)
{
    ReportPayload payload;
    const std::vector<std::uint32_t> few{1, 2, 65535}, many{1, 65536};
    const Json a = payload.indices(few), b = payload.indices(many);
    EXPECT_EQ(a["type"], "uint16");
    EXPECT_EQ(b["type"], "uint32");
    EXPECT_EQ(b["at"], 8) << "after three words, at a multiple of four";
    std::uint32_t read = 0;
    std::memcpy(&read, payload.bytes().data() + b["at"].get<std::size_t>() + 4, 4);
    EXPECT_EQ(read, 65536U);
}

TEST(ReportPayloadTest, HalvesArePartsOfTheLargest)
{
    // Far beyond what 16 bits hold: a scale carries it.
    ReportPayload payload;
    const std::vector<float> bright{1e9F, 5e8F, 0}, dark{0, 0};
    const Json place = payload.halves(bright);
    EXPECT_FLOAT_EQ(place["scale"].get<float>(), 1e9F);
    std::uint16_t words[3];
    std::memcpy(words, payload.bytes().data(), sizeof words);
    EXPECT_THAT(words, ElementsAre(0x3c00, 0x3800, 0)) << "1, 1/2 and 0 as IEEE 754 halves";
    EXPECT_EQ(payload.halves(dark)["scale"], 0.0F);
    EXPECT_EQ(payload.halves({})["count"], 0);
}

TEST(ReportPayloadTest, RoundedPointsArePartsOfTheirBox)
{
    // A flat box has no size in z.
    ReportPayload payload;
    const std::vector<Vec3> points{{-1, 5, 2}, {1, 9, 2}, {0, 6, 2}};
    const Json place = payload.rounded_points(points);
    EXPECT_EQ(place["low"], Json({-1.0, 5.0, 2.0}));
    EXPECT_EQ(place["size"], Json({2.0, 4.0, 0.0}));
    std::uint16_t words[9];
    std::memcpy(words, payload.bytes().data(), sizeof words);
    EXPECT_THAT(words, ElementsAre(0, 0, 0, 65535, 65535, 0, 32768, 16384, 0));
    EXPECT_EQ(payload.rounded_points({})["count"], 0);
}

TEST(ReportDataTest, FirstAndLastCycleAreAlwaysChosenAndTheOthersEvenly)
{
    const std::vector<std::size_t> nine(9, 10);
    EXPECT_EQ(even_choice(nine, 90).size(), 9U);
    EXPECT_THAT(even_choice(nine, 89), ElementsAre(0, 1, 2, 3, 5, 6, 7, 8));
    EXPECT_THAT(even_choice(nine, 50), ElementsAre(0, 2, 4, 6, 8));
    EXPECT_THAT(even_choice(nine, 0), ElementsAre(0, 8));
    EXPECT_THAT(even_choice({10}, 0), ElementsAre(0));
    EXPECT_THAT(even_choice({10, 10}, 0), ElementsAre(0, 1));
}

TEST(ReportPageTest, TheProgramHoldsThePage)
{
    const auto files = report_page_files();
    ASSERT_EQ(files.size(), 6U);
    for (const auto& [name, bytes] : files) {
        EXPECT_GT(bytes.size(), 1000U) << name;
        // Would end the element that it stands in.
        EXPECT_EQ(bytes.find("</script"), bytes.npos) << name;
        EXPECT_EQ(bytes.find("</style"), bytes.npos) << name;
    }
}

}  // namespace
}  // namespace patchlight
