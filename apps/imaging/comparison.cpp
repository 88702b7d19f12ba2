#include "apps/imaging/comparison.h"

#include "apps/imaging/image_file.h"

#include <algorithm>

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

}  // namespace

Image side_by_side(const Captioned& left, const Captioned& right)
{
    const int gap = std::max(4, left.picture.width / 64);
    const int size = std::clamp(left.picture.width / 28, 9, 40);
    const int bar = size * 3 + gap;
    const int height = std::max(left.picture.height, right.picture.height);
    Image result(left.picture.width + right.picture.width + 3 * gap, height + bar + gap);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            result.set(x, y, ground);
        }
    }
    int x = gap;
    for (const Captioned* one : {&left, &right}) {
        paste(one->picture, result, x, gap);
        draw_text(result, x, gap + height + size + gap / 2, one->title, size, bright);
        draw_text(result, x, gap + height + 2 * size + gap, one->detail, std::max(8, size * 3 / 4), dim);
        x += one->picture.width + gap;
    }
    return result;
}

}  // namespace patchlight
