#include "apps/imaging/exposure.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace patchlight {

double auto_exposure(const Scene& scene, const ViewHits& hits, const Image& radiance)
{
    std::vector<double> lit;
    for (int y = 0; y < radiance.height; ++y) {
        for (int x = 0; x < radiance.width; ++x) {
            const std::uint32_t surface = hits.surface[static_cast<std::size_t>(y) * radiance.width + x];
            if (surface >= HitBatch::black_back || scene.material_of(SurfaceId(surface)).emits()) {
                continue;
            }
            const double value = luminance(radiance.at(x, y));
            if (value > 0) {
                lit.push_back(value);
            }
        }
    }
    if (lit.empty()) {
        return 0;
    }
    const auto high = lit.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), high, lit.end());
    return std::log2(0.5 / *high);
}

double white_at(double exposure)
{
    return std::exp2(-exposure);
}

double srgb_encoded(double linear)
{
    linear = std::clamp(linear, 0.0, 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double srgb_decoded(double encoded)
{
    encoded = std::clamp(encoded, 0.0, 1.0);
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Image to_srgb(const Image& radiance, double exposure)
{
    Image result(radiance.width, radiance.height);
    const double scale = std::exp2(exposure);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, radiance.rgb.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            result.rgb[i] = static_cast<float>(srgb_encoded(scale * static_cast<double>(radiance.rgb[i])));
        }
    });
    return result;
}

}  // namespace patchlight
