#pragma once

#include "meshing/vectors.h"

#include <cstddef>
#include <vector>

namespace patchlight {

/// A picture of three floats a pixel, rows from the top. What the floats mean (radiance in W/(m²·sr), or sRGB
/// values between 0 and 1) is said by the function that makes it.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;

    Image() = default;
    Image(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3) {}

    float* pixel(int x, int y) { return rgb.data() + offset(x, y); }
    const float* pixel(int x, int y) const { return rgb.data() + offset(x, y); }
    Rgb at(int x, int y) const
    {
        const float* p = pixel(x, y);
        return {p[0], p[1], p[2]};
    }
    void set(int x, int y, const Rgb& value)
    {
        float* p = pixel(x, y);
        for (int band = 0; band < 3; ++band) {
            p[band] = static_cast<float>(value[band]);
        }
    }

private:
    std::size_t offset(int x, int y) const
    {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3;
    }
};

/// The largest side a picture may have.
inline constexpr int largest_picture_side = 8192;

/// Rec. 709 luminance.
inline double luminance(const Rgb& c)
{
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

}  // namespace patchlight
