#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace patchlight {

/// A picture of one number a pixel, rows from the top. Where there is nothing to show it holds NaN.
struct ScalarImage {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    ScalarImage() = default;
    ScalarImage(int w, int h, float value = 0)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value)
    {}

    float& at(int x, int y) { return values[offset(x, y)]; }
    float at(int x, int y) const { return values[offset(x, y)]; }

private:
    std::size_t offset(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

inline constexpr float nothing_shown = std::numeric_limits<float>::quiet_NaN();

}  // namespace patchlight
