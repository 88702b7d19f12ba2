#include "apps/imaging/image_file.h"
#include "tests/command/command_runner.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A solved run, and the commands that look at it.
class StoredRunTest : public CommandTest {
protected:
    void SetUp() override
    {
        const Outcome outcome = run(small({"solve", write_scene(), "-o", path("run"), "--quiet"}));
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "") << "quiet is quiet";
    }

    Outcome probe(const std::string& points, std::vector<std::string> more = {})
    {
        write_text(path("points.csv"), points);
        std::vector<std::string> words{"probe", path("run"), "--points", path("points.csv")};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    static std::vector<std::vector<std::string>> rows_of(const std::string& csv)
    {
        std::vector<std::vector<std::string>> rows;
        std::istringstream lines(csv);
        for (std::string line; std::getline(lines, line);) {
            rows.emplace_back();
            std::istringstream fields(line + ",");
            for (std::string field; std::getline(fields, field, ',');) {
                rows.back().push_back(field);
            }
        }
        return rows;
    }
};

TEST_F(StoredRunTest, APixelOfViewExrTimesPiIsWhatProbeSaysOfThePointItShows)
{
    const Image image = read_image(path("run/view.exr")).image;
    ASSERT_EQ(image.width, 32);
    // The camera of room.view.json, by its definition.
    const double from[] = {0.5, 0.6, 2.4}, half = std::tan(20 * std::numbers::pi / 180);
    const double length = std::hypot(0.2, 2.4), fy = -0.2 / length, fz = -2.4 / length;
    std::string points;
    std::vector<std::pair<int, int>> pixels;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const double across = half * (2 * (x + 0.5) - 32) / 32, up = half * (32 - 2 * (y + 0.5)) / 32;
            const double d[] = {across, fy - up * fz, fz + up * fy};
            const double t = -from[1] / d[1], px = from[0] + t * d[0], pz = from[2] + t * d[2];
            if (d[1] < 0 && px > 0 && px < 1 && pz > 0 && pz < 1) {
                points += fmt::format("{},0,{},0,1,0\n", px, pz);
                pixels.emplace_back(x, y);
            }
        }
    }
    ASSERT_GT(pixels.size(), 50U);
    const auto rows = rows_of(probe(points).out);
    ASSERT_EQ(rows.size(), pixels.size() + 1);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (int band = 0; band < 3; ++band) {
            const double B = std::stod(rows[i + 1][3 + static_cast<std::size_t>(band)]);
            // Single precision in the file, and the last bits of coordinates relative to another centre.
            EXPECT_NEAR(std::numbers::pi * image.at(pixels[i].first, pixels[i].second)[band], B,
                        1e-6 * std::max(B, 1e-3));
        }
    }
}

TEST_F(StoredRunTest, ProbeAnswersEveryRowInOrder)
{
    const Outcome outcome =
        probe("x,y,z,nx,ny,nz\n.50,0,.5,0,1,0\n.5,0,.5,0,-1,0\n0,0,0,0,1,0\n5,5,5,0,1,0\n.5,.5,.5,0,-1,0\n");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("2 of 5 points"));
    const auto rows = rows_of(outcome.out);
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[0], (std::vector<std::string>{"x", "y", "z", "Br", "Bg", "Bb", "surface"}));
    EXPECT_EQ(rows[1][0], ".50") << "coordinates stand as they were written";
    EXPECT_GT(std::stod(rows[1][3]), 0);
    EXPECT_EQ(rows[2][3], "") << "the floor has no other side";
    EXPECT_GT(std::stod(rows[3][3]), 0) << "a corner of the floor";
    EXPECT_EQ(rows[4][3], "");
    // A lamp that reflects nothing: E = π Ke, exactly what the file says.
    EXPECT_NEAR(std::stod(rows[5][3]), 10 * std::numbers::pi, 1e-9);
    const Outcome first = probe(".5,0,.5\n", {"--cycle", "first"});
    EXPECT_EQ(first.code, 0);
    EXPECT_EQ(probe(".5,0,.5\n", {"-o", path("new/answers.csv")}).out, "");
    EXPECT_THAT(text_of(path("new/answers.csv")), StartsWith("x,y,z,"));
}

TEST_F(StoredRunTest, PointsThatCannotBeReadAreTwoWithTheLine)
{
    const Outcome outcome = probe("1,2,3\n1,2,three\n");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(StartsWith("error[points]: "), HasSubstr("points.csv:2: \"three\"")));
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(run({"probe", path("run"), "--points", path("none.csv")}).code, 2);
}

TEST_F(StoredRunTest, RendersAnyView)
{
    for (const std::vector<std::string>& how : {std::vector<std::string>{"--shade", "flat", "--cycle", "first"},
                                                {"--wireframe", "--cycle", "0"},
                                                {"--view", "front", "--exposure", "-2.5"},
                                                {"--from", "0.9,0.9,0.9", "--to", "0.1,0.1,0.1", "--fov", "80"}}) {
        std::vector<std::string> words{"render", path("run"), "-o", path("pictures/a.png"), "--size", "40x30"};
        words.insert(words.end(), how.begin(), how.end());
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Image image = read_image(path("pictures/a.png")).image;
        EXPECT_EQ(image.width, 40);
        EXPECT_EQ(image.height, 30);
        EXPECT_GT(*std::max_element(image.rgb.begin(), image.rgb.end()), 0.1F);
    }
    ASSERT_EQ(run({"render", path("run"), "-o", path("a.exr"), "--size", "32x32"}).code, 0);
    EXPECT_EQ(read_image(path("a.exr")).image.rgb, read_image(path("run/view.exr")).image.rgb);
    EXPECT_EQ(run({"render", path("run"), "-o", path("b.png"), "--cycle", "99"}).code, 2);
    EXPECT_EQ(run({"render", path("run"), "-o", path("b.png"), "--view", "back"}).code, 2);
    EXPECT_FALSE(std::filesystem::exists(path("b.png")));
}

// Where single precision, and Embree with it, gives up; scene files bring cameras, too.
TEST_F(StoredRunTest, FromTooFarAwayNothingIsSeen)
{
    for (const std::string away : {"1e18,1,1", "1e38,1e38,1e38", "-1e300,0,0"}) {
        std::vector<std::string> words{"render", path("run"), "-o", path("far.png"), "--size",
                                       "40x30",  "--from",    away, "--to",          "1,1,1"};
        const Outcome outcome = run(words);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const Image image = read_image(path("far.png")).image;
        EXPECT_EQ(*std::max_element(image.rgb.begin(), image.rgb.end()), 0.0F) << away;
        words.push_back("--wireframe");
        EXPECT_EQ(run(words).code, 0) << "its legend is drawn, no line is";
    }
}

TEST_F(StoredRunTest, ExportsItsFormats)
{
    ASSERT_EQ(run({"export", path("run"), "--format", "glb", "-o", path("a.glb")}).code, 0);
    EXPECT_TRUE(text_of(path("a.glb")) == text_of(path("run/solution.glb")));
    ASSERT_EQ(run({"export", path("run"), "--format", "ply", "-o", path("a.ply")}).code, 0);
    EXPECT_THAT(text_of(path("a.ply")).substr(0, 40), StartsWith("ply\nformat binary_little_endian 1.0\n"));
    ASSERT_EQ(run({"export", path("run"), "--format", "csv", "-o", path("a.csv")}).code, 0);
    EXPECT_THAT(text_of(path("a.csv")), StartsWith("patch,surface,material,x,y,z,area,Br,Bg,Bb,eta\n"));
    EXPECT_EQ(run({"export", path("run"), "--format", "csv", "-o", "/proc/patchlight/a.csv"}).code, 6);
}

TEST_F(StoredRunTest, WhatIsNoRunIsTwoAndABrokenOneThree)
{
    EXPECT_EQ(run({"render", path("nowhere"), "-o", path("a.png")}).code, 2);
    EXPECT_EQ(run({"render", path("scratch"), "-o", path("a.png")}).code, 2);
    const std::string glb = text_of(path("run/solution.glb"));
    for (const std::string& broken :
         {glb.substr(0, glb.size() / 2), std::string("glTF"), std::string(), std::string(5000, 'x')}) {
        write_text(path("run/solution.glb"), broken);
        const Outcome outcome = run({"render", path("run"), "-o", path("a.png")});
        EXPECT_EQ(outcome.code, 3) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("solution.glb"));
    }
    write_text(path("run/run.json"), std::string(100'000, '['));
    EXPECT_EQ(run({"probe", path("run"), "--points", write_scene()}).code, 2);
    EXPECT_EQ(run({"export", path("run"), "--format", "csv", "-o", path("a.csv")}).code, 3);
}

TEST_F(StoredRunTest, AFullStandardOutputIsSix)
{
    write_text(path("points.csv"), "0.5,0,0.5\n");
    const Outcome outcome =
        run({"probe", path("run"), "--points", path("points.csv")}, {.standard_output = "/dev/full"});
    EXPECT_EQ(outcome.code, 6);
    EXPECT_THAT(outcome.err, HasSubstr("error[output]: standard output"));
}

TEST_F(StoredRunTest, AClosedPipeEndsQuietlyAndTheRunIsWhole)
{
    const std::string fifo = path("fifo");
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    RunningCommand solving(small({"solve", write_scene(), "-o", path("piped"), "--quiet"}), folder_ / "scratch",
                           {.standard_output = fifo});
    ::close(::open(fifo.c_str(), O_RDONLY));
    const Outcome outcome = solving.wait();
    EXPECT_EQ(outcome.code, 128 + SIGPIPE);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(lasting_files_in(folder_ / "piped"), lasting_files_in(folder_ / "run"));
}

TEST_F(StoredRunTest, JsonIsRunJson)
{
    const Outcome outcome = run(small({"solve", write_scene(), "-o", path("run"), "--quiet", "--json"}));
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, text_of(path("run/run.json")));
}

}  // namespace
}  // namespace patchlight::testing
