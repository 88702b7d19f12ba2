#include "apps/imaging/animation.h"
#include "apps/imaging/camera_path.h"
#include "apps/imaging/comparison.h"
#include "apps/imaging/image_file.h"
#include "tests/temporary_folder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace patchlight {
namespace {

Image uniform(int width, int height, const Rgb& color)
{
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) image.set(x, y, color);
    }
    return image;
}

TEST(Comparison, AWipeIsHalfOfEachWithALineBetween)
{
    const Image image = wiped(uniform(21, 4, {1, 0, 0}), uniform(21, 4, {0, 0, 1}));
    EXPECT_EQ(image.at(0, 2), Rgb(1, 0, 0));
    EXPECT_EQ(image.at(8, 2), Rgb(1, 0, 0));
    EXPECT_EQ(image.at(10, 2), Rgb(1.0));
    EXPECT_EQ(image.at(12, 2), Rgb(0, 0, 1));
    EXPECT_EQ(image.at(20, 2), Rgb(0, 0, 1));
    EXPECT_EQ(wiped(uniform(1, 1, Rgb(0.0)), uniform(1, 1, Rgb(0.0))).width, 1);
    EXPECT_THROW(wiped(Image(2, 3), Image(3, 2)), std::invalid_argument);
}

TEST(Comparison, DifferencesAreWeighedAsLuminance)
{
    const Image a = uniform(2, 2, {1, 2, 3}), b = uniform(2, 2, {2, 1, 3});
    EXPECT_NEAR(signed_difference(a, b).at(1, 1), 0.7152 - 0.2126, 1e-7);
    EXPECT_NEAR(absolute_difference(a, b).at(1, 1), 0.7152 + 0.2126, 1e-7);
    EXPECT_NEAR(root_mean_square(a, b), std::sqrt(2.0 / 3), 1e-12);
    EXPECT_EQ(root_mean_square(a, a), 0);
    EXPECT_THROW(signed_difference(a, Image(1, 1)), std::invalid_argument);
}

TEST(Animation, HoldsEveryFrameWithItsTime)
{
    const std::vector<std::vector<unsigned char>> frames{encode_png(uniform(6, 5, {1, 0, 0})),
                                                         encode_png(uniform(6, 5, {0, 1, 0})),
                                                         encode_png(uniform(6, 5, {0, 0, 1}))};
    const auto bytes = encode_animation(frames, 120);
    EXPECT_EQ(bytes, encode_animation(frames, 120)) << "same frames, same bytes";
    const std::string text(bytes.begin(), bytes.end());
    std::vector<std::string> types;
    std::vector<int> sequence, times;
    for (std::size_t at = 8; at < text.size();) {
        const auto number = [&](std::size_t where, std::size_t size) {
            int value = 0;
            for (std::size_t k = 0; k < size; ++k) value = value * 256 + bytes[where + k];
            return value;
        };
        const std::string type = text.substr(at + 4, 4);
        types.push_back(type);
        if (type == "fcTL" || type == "fdAT") sequence.push_back(number(at + 8, 4));
        if (type == "fcTL") times.push_back(number(at + 28, 2));
        EXPECT_TRUE(type != "acTL" || number(at + 8, 4) == 3);
        at += 12 + static_cast<std::size_t>(number(at, 4));
    }
    EXPECT_EQ(types.front(), "IHDR");
    EXPECT_EQ(types.back(), "IEND");
    EXPECT_EQ(std::ranges::count(types, "fcTL"), 3);
    EXPECT_EQ(std::ranges::count(types, "fdAT"), 2);
    EXPECT_EQ(times, (std::vector<int>{120, 120, 360}));
    for (std::size_t i = 0; i < sequence.size(); ++i) EXPECT_EQ(sequence[i], static_cast<int>(i));
    // A reader that knows no animations checks every chunk's CRC and sees the first frame.
    const testing::TemporaryFolder folder;
    EXPECT_EQ(read_image(folder.write("a.png", text)).image.at(3, 3), Rgb(1, 0, 0));
}

TEST(Animation, WhatIsNoFrameIsRefused)
{
    const auto png = encode_png(uniform(6, 5, {1, 0, 0}));
    EXPECT_THROW(encode_animation({}, 10), std::invalid_argument);
    EXPECT_THROW(encode_animation({png}, 0), std::invalid_argument);
    EXPECT_THROW(encode_animation({png}, 65536), std::invalid_argument);
    EXPECT_THROW(encode_animation({png, encode_png(uniform(5, 6, {1, 0, 0}))}, 10), std::invalid_argument);
    EXPECT_THROW(encode_animation({{}}, 10), std::invalid_argument);
    EXPECT_THROW(encode_animation({std::vector<unsigned char>(100, 'x')}, 10), std::invalid_argument);
    for (const std::size_t size : {8U, 11U, 20U, 40U}) {
        EXPECT_THROW(encode_animation({{png.begin(), png.begin() + static_cast<std::ptrdiff_t>(size)}}, 10),
                     std::invalid_argument)
            << size;
    }
}

std::vector<View> keys()
{
    std::vector<View> views(4);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto x = static_cast<double>(i);
        views[i].from = {x, x * x, 0};
        views[i].forward = glm::normalize(Vec3(1, x, 0));
        views[i].vertical_fov = 30 + 10 * x;
    }
    return views;
}

TEST(CameraPath, PassesThroughItsKeysSmoothly)
{
    const std::vector<View> views = keys();
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View view = view_on_path(views, static_cast<double>(i));
        EXPECT_LT(glm::distance(view.from, views[i].from), 1e-12);
        EXPECT_LT(glm::distance(view.forward, views[i].forward), 1e-12);
        EXPECT_NEAR(view.vertical_fov, views[i].vertical_fov, 1e-12);
    }
    // Catmull-Rom is exact for a parabola where all four keys lie on it.
    EXPECT_LT(glm::distance(view_on_path(views, 1.5).from, Vec3(1.5, 2.25, 0)), 1e-12);
    const double h = 1e-6;
    const Vec3 before = (view_on_path(views, 2).from - view_on_path(views, 2 - h).from) / h;
    const Vec3 after = (view_on_path(views, 2 + h).from - view_on_path(views, 2).from) / h;
    EXPECT_LT(glm::distance(before, after), 1e-4) << "no kink at a key";
    EXPECT_NEAR(glm::length(view_on_path(views, 0.3).forward), 1, 1e-12);
    EXPECT_EQ(view_on_path(views, 99).from, view_on_path(views, 3).from);
    EXPECT_EQ(view_on_path({views[1]}, 0.5).from, views[1].from);
}

TEST(CameraPath, DirectionsThatCancelStillMakeACamera)
{
    std::vector<View> views(2);
    views[1].forward = -views[0].forward;
    for (const double t : {0.4, 0.5, 0.6}) {
        EXPECT_NEAR(glm::length(view_on_path(views, t).forward), 1, 1e-12) << t;
    }
}

}  // namespace
}  // namespace patchlight
