#include "apps/run/run_folder.h"
#include "apps/run/sha256.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

/// A folder of a run that was killed after its first cycle, with this timing.json.
class KilledRun {
public:
    explicit KilledRun(const std::string& timing)
    {
        identity_.scene_file = "room.obj";
        RunFolder folder(path(), identity_, writer_);
        finish(folder, 0);
        files_.write("run/timing.json", timing);
    }

    /// The next cycle, and the end.
    Json gone_on()
    {
        RunFolder folder(path(), identity_, writer_);
        EXPECT_EQ(folder.record().cycles.size(), 1U);
        finish(folder, 1);
        folder.finish(RunStatus::finished, true, {{"host", "here"}});
        return Json::parse(read_bytes(path() / "timing.json"));
    }

private:
    std::filesystem::path path() const { return files_.path() / "run"; }

    static void finish(RunFolder& folder, int cycle)
    {
        folder.write_in_cycle(cycle, "solution.glb", "light");
        CycleRecord record;
        record.cycle = cycle;
        record.solution_sha256 = sha256_hex("light");
        folder.finish_cycle(record, {{"cycle", cycle}, {"seconds", 1}});
    }

    testing::TemporaryFolder files_;
    FileWriter writer_;
    RunIdentity identity_;
};

TEST(RunFolder, SecondsOfTheCyclesBeforeAreKept)
{
    const Json timing = KilledRun(R"({"cycles": [{"cycle": 0, "seconds": 7}, {"cycle": 1}]})").gone_on();
    EXPECT_EQ(timing.at("cycles").size(), 2U);
    EXPECT_EQ(timing.at("cycles").at(0).at("seconds"), 7);
    EXPECT_EQ(timing.at("host"), "here");
}

TEST(RunFolder, ATimingFileThatIsNoneOnlyLosesSeconds)
{
    const std::string deep(1'000'000, '[');
    for (const std::string& text :
         {std::string("[1]"), std::string("5"), std::string("{\"cycles\": 3}"), std::string("{"),
          std::string(R"({"cycles": [5, {"cycle": "zero"}, {"cycle": 1e300}, {}]})"),
          deep + std::string(1'000'000, ']'), "{\"deep\": " + deep + std::string(1'000'000, ']') + "}"}) {
        const Json timing = KilledRun(text).gone_on();
        EXPECT_EQ(timing.at("cycles").size(), 1U) << text.substr(0, 80);
        EXPECT_EQ(timing.at("host"), "here");
    }
}

}  // namespace
}  // namespace patchlight
