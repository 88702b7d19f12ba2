#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// One scene of each kind that can't be solved; the readers' own tests know many more.
class BadSceneTest : public CommandTest {
protected:
    void expect_refused(const std::string& file, const std::string& code, const std::string& part)
    {
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{"inspect", file}, {"solve", file, "-o", path("run")}}) {
            const Outcome outcome = run(words);
            EXPECT_EQ(outcome.code, 3) << outcome.err;
            EXPECT_THAT(outcome.err, AllOf(HasSubstr("error[" + code + "]: "), HasSubstr(part)));
            EXPECT_EQ(outcome.out, "");
        }
        EXPECT_FALSE(std::filesystem::exists(path("run")));
    }

    std::string with(const std::string& name, const std::string& text)
    {
        write_scene();
        write_text(folder_ / name, text);
        return path(name);
    }
};

TEST_F(BadSceneTest, FilesThatCannotBeRead)
{
    expect_refused(path("nothing.obj"), "file", "nothing.obj");
    std::filesystem::create_directory(folder_ / "folder.obj");
    expect_refused(path("folder.obj"), "file", "folder.obj");
    expect_refused(with("scene.xyz", "hello"), "format", "scene.xyz");
}

TEST_F(BadSceneTest, NothingToSolve)
{
    expect_refused(with("empty.obj", "v 0 0 0\n"), "empty", "empty.obj");
    expect_refused(with("dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "dark", "--emitter");
}

TEST_F(BadSceneTest, NumbersThatAreNone)
{
    expect_refused(with("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), "nonfinite", "nan.obj:2");
    expect_refused(with("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "index", "index.obj:4");
    const std::string white = "mtllib white.mtl\nusemtl white\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    with("white.mtl", "newmtl white\nKd 1.5 1 1\nKe 1 1 1\n");
    expect_refused(with("rho.obj", white), "material", "reflectance 1.5");
    // Single precision would make other light of it, or none.
    for (const std::string E : {"1e-40", "1e40"}) {
        with("white.mtl", "newmtl white\nKd .5 .5 .5\nKe 0 0 " + E + "\n");
        expect_refused(with("bright.obj", white), "material", "material white: the brightest exitance");
    }
}

TEST_F(BadSceneTest, AMisspeltMaterialIsNamedAndTheOthersListed)
{
    for (const char* option : {"--emitter", "--two-sided"}) {
        const std::string value = option == std::string("--emitter") ? "lmap=3" : "lmap";
        const Outcome outcome = run({"inspect", write_scene(), option, value});
        EXPECT_EQ(outcome.code, 3);
        EXPECT_THAT(outcome.err,
                    AllOf(StartsWith("error[material]: "), HasSubstr("lmap"), HasSubstr("lamp, red, white")));
    }
}

TEST_F(BadSceneTest, ATruncatedFile)
{
    const std::string whole = text_of(PATCHLIGHT_DATA "/scenes/cornell-box.glb");
    const Outcome outcome = run({"inspect", with("cut.glb", whole.substr(0, 200))});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, AllOf(StartsWith("error["), HasSubstr("cut.glb")));
}

TEST_F(BadSceneTest, AFlippedLampAndMixedWindingAreToldWithTheirShares)
{
    std::string flipped = scene_text;
    flipped.replace(flipped.find("f 7 8 9 10"), 10, "f 10 9 8 7");
    const Outcome lamp = run({"inspect", with("flipped.obj", flipped)});
    EXPECT_EQ(lamp.code, 0);
    EXPECT_THAT(lamp.err, HasSubstr("% of the emitted flux leaves the scene"));
    std::string mixed = scene_text;
    mixed.replace(mixed.find("f 1 2 6 5"), 9, "f 5 6 2 1");
    EXPECT_THAT(run({"inspect", with("mixed.obj", mixed)}).err, HasSubstr("meet black backs first"));
    EXPECT_EQ(run({"inspect", write_scene()}).err, "") << "nothing to warn of";
}

TEST_F(BadSceneTest, InspectTellsWhatWasRead)
{
    const Outcome outcome = run({"inspect", write_scene(), "--json", "--two-sided", "red", "--unit", "cm"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* part : {"\"closed\": false", "\"name\": \"lamp\"", "\"unit\": 0.01", "\"emitted_power\"",
                             "\"t_junctions\"", "\"first_hits\"", "\"front\""}) {
        EXPECT_THAT(outcome.out, HasSubstr(part));
    }
}

}  // namespace
}  // namespace patchlight::testing
