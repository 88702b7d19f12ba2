#include "apps/run/run_record.h"
#include "meshing/scene_error.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

Json stored()
{
    RunRecord record;
    record.identity.options = Json::object();
    record.cycles.emplace_back();
    return Json::parse(json_of(record).dump());
}

TEST(RunRecord, ComesBack)
{
    EXPECT_EQ(json_of(run_record_in(stored().dump()).record), stored());
}

TEST(RunRecord, CountsThatNoNumberHoldsAreRefused)
{
    // Turned into a count, any of these is undefined or another number.
    for (const char* text : {"1.8446744073709552e19", "1e99", "-1", "2.5", "18446744073709551616", "null", "\"3\""}) {
        for (const char* place : {"/cycles/0/lines/contact/found", "/cycles/0/elements", "/cycles/0/solve/links",
                                  "/scene/surfaces", "/seed"}) {
            Json json = stored();
            const Json::json_pointer at(place);
            ASSERT_TRUE(json.contains(at)) << place;
            json[at] = Json::parse(text);
            EXPECT_THROW(run_record_in(json.dump()), SceneError) << place << ": " << text;
        }
    }
}

}  // namespace
}  // namespace patchlight
