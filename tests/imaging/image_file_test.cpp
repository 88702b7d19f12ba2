#include "apps/imaging/comparison.h"
#include "apps/imaging/exposure.h"
#include "apps/imaging/image_file.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace patchlight {
namespace {

Image ramp(int width, int height, float scale)
{
    Image image(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = scale * static_cast<float>(i) / static_cast<float>(image.rgb.size() - 1);
    }
    return image;
}

class ImageFileTest : public ::testing::Test {
protected:
    ImageFile through_a_file(const std::vector<unsigned char>& bytes, const std::string& extension)
    {
        return read_image(folder_.write("image" + extension, std::string(bytes.begin(), bytes.end())));
    }

    const testing::TemporaryFolder folder_;
};

TEST_F(ImageFileTest, APngKeepsEightBits)
{
    const Image image = ramp(31, 17, 1);
    const ImageFile read = through_a_file(encode_png(image), ".png");
    ASSERT_EQ(read.image.width, 31);
    ASSERT_EQ(read.image.height, 17);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        EXPECT_NEAR(read.image.rgb[i], image.rgb[i], 0.5 / 255 + 1e-6);
    }
}

TEST_F(ImageFileTest, AnExrKeepsEveryBitAndItsMetadata)
{
    const Image image = ramp(20, 10, 1234.5F);
    const ImageFile read = through_a_file(encode_exr(image, {{"patchlight:unit", "W/(m2 sr)"}}), ".exr");
    EXPECT_EQ(read.image.rgb, image.rgb);
    EXPECT_EQ(read.metadata.at("patchlight:unit"), "W/(m2 sr)");
    EXPECT_EQ(read.metadata.at("Software"), "patchlight");
}

TEST_F(ImageFileTest, NoDateOfTodayGetsIn)
{
    for (const auto& bytes : {encode_exr(ramp(8, 8, 1), {}), encode_png(ramp(8, 8, 1))}) {
        const ImageFile read = through_a_file(bytes, bytes[0] == 0x89 ? ".png" : ".exr");
        EXPECT_TRUE(!read.metadata.contains("DateTime") || read.metadata.at("DateTime").empty());
    }
}

TEST(ImageFile, ABrokenFileIsAnErrorWithItsPath)
{
    const testing::TemporaryFolder folder;
    const auto file = folder.write("broken.png", "not a picture");
    try {
        read_image(file);
        ADD_FAILURE() << "read";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
    }
}

TEST(DrawText, WritesIntoThePictureAndNowhereElse)
{
    Image image(200, 60);
    ASSERT_TRUE(draw_text(image, 10, 40, "7997 elements", 20, Rgb(1.0))) << "needs fonts-dejavu-core";
    EXPECT_GT(std::count_if(image.rgb.begin(), image.rgb.end(), [](float v) { return v > 0.5F; }), 200);
    for (int y = 50; y < 60; ++y) {
        for (int x = 0; x < 200; ++x) {
            EXPECT_EQ(image.at(x, y), Rgb(0.0)) << "below the baseline there is nothing";
        }
    }
}

TEST(DrawText, OutsideThePictureIsHarmless)
{
    Image image(20, 20);
    draw_text(image, -500, 10, "left of it", 12, Rgb(1.0));
    draw_text(image, 5000, 10, "right of it", 12, Rgb(1.0));
    draw_text(image, 5, 10, "wider than the picture by far", 40, Rgb(1.0));
    EXPECT_EQ(image.rgb.size(), 20U * 20U * 3U);
}

TEST(SideBySide, HoldsBothPicturesUnchanged)
{
    const Image left = ramp(64, 48, 1), right = ramp(64, 48, 0.5F);
    const Image both = side_by_side({left, "before", "10 %"}, {right, "after", "1 %"});
    const auto holds = [&](const Image& part, int x0, int y0) {
        for (int y = 0; y < part.height; ++y) {
            for (int x = 0; x < part.width; ++x) {
                if (both.at(x0 + x, y0 + y) != part.at(x, y)) {
                    return false;
                }
            }
        }
        return true;
    };
    const int gap = (both.width - 128) / 3;
    EXPECT_TRUE(holds(left, gap, gap));
    EXPECT_TRUE(holds(right, 2 * gap + 64, gap));
    EXPECT_GT(both.height, 48 + 2 * gap) << "room for the captions";
}

TEST(Srgb, HasTheStandardsValues)
{
    EXPECT_EQ(srgb_encoded(0), 0);
    EXPECT_NEAR(srgb_encoded(1), 1, 1e-15);
    EXPECT_NEAR(srgb_encoded(0.5), 0.7353569830524495, 1e-12);  // IEC 61966-2-1
    EXPECT_NEAR(srgb_encoded(0.0031308), 0.0031308 * 12.92, 1e-15);
    EXPECT_EQ(srgb_encoded(7), srgb_encoded(1));
}

}  // namespace
}  // namespace patchlight
