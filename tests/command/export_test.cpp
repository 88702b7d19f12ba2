#include "apps/imaging/image_file.h"
#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// What tests/files checks the content of: here where files go, and what is refused.
class ExportTest : public CommandTest {
protected:
    void SetUp() override
    {
        const Outcome outcome =
            run(small({"solve", write_scene(), "-o", path("run"), "--quiet", "--pictures", "none"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }

    Outcome exported(const std::string& format, const std::string& file, std::vector<std::string> more = {})
    {
        std::vector<std::string> words{"export", path("run"), "--format", format, "-o", file};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
};

TEST_F(ExportTest, ASeriesHasAFileForEachCycleBesideIt)
{
    ASSERT_EQ(exported("pvd", path("new/room < 1.pvd")).code, 0);
    const auto files = files_in(folder_ / "new");
    const std::string series = files.at("room < 1.pvd");
    std::size_t cycles = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "run" / "cycles")) {
        const std::string number = entry.path().filename().string();
        EXPECT_TRUE(files.contains("room < 1-" + number + ".vtu"));
        EXPECT_THAT(series, HasSubstr("file=\"room &lt; 1-" + number + ".vtu\""));
        ++cycles;
    }
    EXPECT_GE(cycles, 2U);
    EXPECT_EQ(files.size(), cycles + 1);
    ASSERT_EQ(exported("vtu", path("first.vtu"), {"--cycle", "first"}).code, 0);
    EXPECT_TRUE(text_of(path("first.vtu")) == files.at("room < 1-00.vtu"));
    ASSERT_EQ(exported("glb", path("first.glb"), {"--cycle", "0"}).code, 0);
    EXPECT_TRUE(text_of(path("first.glb")) == text_of(path("run/cycles/00/solution.glb")));
}

TEST_F(ExportTest, ALightmapIsAPictureAndAGlbThatNamesIt)
{
    ASSERT_EQ(exported("lightmap", path("maps/room.exr"), {"--size", "64"}).code, 0);
    const auto files = files_in(folder_ / "maps");
    EXPECT_EQ(files.size(), 2U);
    EXPECT_THAT(files.at("room.glb"), HasSubstr("\"lightmap\":\"room.exr\""));
    const ImageFile picture = read_image(path("maps/room.exr"));
    EXPECT_LE(std::max(picture.image.width, picture.image.height), 64);
    EXPECT_EQ(picture.metadata.at("patchlight:quantity"), "radiosity B");
    ASSERT_EQ(exported("lightmap", path("maps/room.exr"), {"--size", "64"}).code, 0);
    EXPECT_EQ(files_in(folder_ / "maps"), files) << "the same bytes";
    ASSERT_EQ(exported("lightmap", path("maps/H.exr"), {"--quantity", "irradiance", "--texels-per-metre", "20"}).code,
              0);
    EXPECT_EQ(read_image(path("maps/H.exr")).metadata.at("patchlight:quantity"), "irradiance (B-E)/rho");
}

TEST_F(ExportTest, WhatCannotBeIsRefusedAndLeavesNothing)
{
    const Outcome dense = exported("lightmap", path("a.exr"), {"--texels-per-metre", "1000", "--size", "256"});
    EXPECT_EQ(dense.code, 2);
    EXPECT_THAT(dense.err, AllOf(StartsWith("error[lightmap]: "), HasSubstr("256"), HasSubstr("--texels-per-metre")));
    EXPECT_EQ(exported("vtu", path("a.vtu"), {"--cycle", "99"}).code, 2);
    EXPECT_EQ(exported("vtu", "/proc/patchlight/a.vtu").code, 6);
    EXPECT_EQ(exported("pvd", "/proc/patchlight/a.pvd").code, 6);
    EXPECT_EQ(exported("lightmap", "/proc/patchlight/a.exr").code, 6);
    write_text(path("run/cycles/00/solution.glb"), "glTF");
    EXPECT_EQ(exported("pvd", path("a.pvd")).code, 3);
    for (const char* name : {"a.exr", "a.glb", "a.vtu", "a.pvd"}) EXPECT_FALSE(std::filesystem::exists(path(name)));
}

TEST_F(ExportTest, ADiskThatIsFullIsSix)
{
    const Outcome outcome =
        run({"export", path("run"), "--format", "vtu", "-o", path("a.vtu")}, {.largest_file = 1000});
    EXPECT_EQ(outcome.code, 6) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("a.vtu")));
}

}  // namespace
}  // namespace patchlight::testing
