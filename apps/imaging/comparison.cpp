#include "apps/imaging/comparison.h"

#include "apps/imaging/image_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace patchlight {

namespace {

const Rgb ground{0.09, 0.09, 0.10};
const Rgb bright{0.95, 0.95, 0.95};
const Rgb dim{0.70, 0.72, 0.75};

void paste(const Image& from, Image& to, int x0, int y0)
{
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.pixel(0, y), static_cast<std::ptrdiff_t>(from.width) * 3, to.pixel(x0, y0 + y));
    }
}

void check_sizes(const Image& a, const Image& b)
{
    if (a.width != b.width || a.height != b.height) {
        throw std::invalid_argument("pictures of different sizes can't be compared");
    }
}

template <class Number>
ScalarImage differences(const Image& a, const Image& b, const Number& number_of)
{
    check_sizes(a, b);
    ScalarImage result(a.width, a.height);
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            result.at(x, y) = static_cast<float>(number_of(a.at(x, y) - b.at(x, y)));
        }
    }
    return result;
}

}  // namespace

Image in_a_row(const std::vector<Captioned>& pictures)
{
    const int first = pictures.front().picture.width;
    const int gap = std::max(4, first / 64);
    const int size = std::clamp(first / 28, 9, 40);
    const int bar = size * 3 + gap;
    int width = gap, height = 0;
    for (const Captioned& one : pictures) {
        width += one.picture.width + gap;
        height = std::max(height, one.picture.height);
    }
    Image result(width, height + bar + gap);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            result.set(x, y, ground);
        }
    }
    int x = gap;
    for (const Captioned& one : pictures) {
        paste(one.picture, result, x, gap);
        draw_text(result, x, gap + height + size + gap / 2, one.title, size, bright);
        draw_text(result, x, gap + height + 2 * size + gap, one.detail, std::max(8, size * 3 / 4), dim);
        x += one.picture.width + gap;
    }
    return result;
}

Image side_by_side(const Captioned& left, const Captioned& right)
{
    return in_a_row({left, right});
}

Image wiped(const Image& left, const Image& right)
{
    check_sizes(left, right);
    const int middle = left.width / 2, half = std::max(1, left.width / 640);
    Image result = left;
    for (int y = 0; y < left.height; ++y) {
        std::copy_n(right.pixel(middle, y), static_cast<std::ptrdiff_t>(left.width - middle) * 3,
                    result.pixel(middle, y));
        for (int x = std::max(0, middle - half); x < std::min(middle + half, left.width); ++x) {
            result.set(x, y, Rgb(1.0));
        }
    }
    return result;
}

ScalarImage absolute_difference(const Image& a, const Image& b)
{
    return differences(a, b, [](const Rgb& difference) { return luminance(glm::abs(difference)); });
}

ScalarImage signed_difference(const Image& a, const Image& b)
{
    return differences(a, b, [](const Rgb& difference) { return luminance(difference); });
}

double root_mean_square(const Image& a, const Image& b)
{
    check_sizes(a, b);
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const double difference = double(a.rgb[i]) - double(b.rgb[i]);
        sum += difference * difference;
    }
    return a.rgb.empty() ? 0 : std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

}  // namespace patchlight
