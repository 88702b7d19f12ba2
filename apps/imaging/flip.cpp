#include "apps/imaging/flip.h"

#include "apps/imaging/separable_filter.h"

#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace patchlight {

namespace {

constexpr double color_exponent = 0.7, feature_exponent = 0.5;
constexpr double knee_at = 0.4, knee_value = 0.95;
constexpr double feature_width = 0.082;  // degrees

using Planes = std::array<ScalarImage, 3>;

// Rec. 709 primaries and D65 (x .3127, y .3290); columns are the primaries.
const glm::dmat3 xyz_of_rgb{0.41239079926595934, 0.21263900587151027, 0.01933081871559182,
                            0.35758433938387800, 0.71516867876775600, 0.11919477979462598,
                            0.18048078840183430, 0.07219231536073371, 0.95053215224966070};
const glm::dmat3 rgb_of_xyz = glm::inverse(xyz_of_rgb);
const Vec3 white_xyz = xyz_of_rgb * Vec3(1.0);

Vec3 opponent_of(const Rgb& linear)
{
    const Vec3 t = xyz_of_rgb * linear / white_xyz;
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}

Rgb linear_of(const Vec3& opponent)
{
    const double y = (opponent.x + 16) / 116;
    return rgb_of_xyz * (Vec3(y + opponent.y / 500, y, y - opponent.z / 200) * white_xyz);
}

/// CIE L*a*b*, a* and b* scaled by L*/100: dark colours look less colourful (Hunt).
Vec3 hunt_lab_of(const Rgb& linear)
{
    const auto f = [](double t) {
        constexpr double d = 6.0 / 29;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    };
    const Vec3 t = xyz_of_rgb * linear / white_xyz;
    const double L = 116 * f(t.y) - 16;
    return {L, 0.01 * L * 500 * (f(t.x) - f(t.y)), 0.01 * L * 200 * (f(t.y) - f(t.z))};
}

double hyab(const Vec3& a, const Vec3& b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// A distance of colours to 0 … 1: linear to the knee, what is above squeezed.
double color_error(double distance)
{
    static const double largest = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), color_exponent);
    const double d = std::pow(distance, color_exponent), knee = knee_at * largest;
    return d < knee ? knee_value / knee * d : knee_value + (d - knee) / (largest - knee) * (1 - knee_value);
}

/// exp(−π²x²/b), x in degrees: the eye's exp(−b f²) over frequencies, as a filter.
std::vector<float> sensitivity(double b, double ppd)
{
    // One radius for all: three standard deviations of the widest.
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / 2) / std::numbers::pi * ppd));
    return sampled(radius, [&](double x) {
        x *= std::numbers::pi / ppd;
        return std::exp(-x * x / b);
    });
}

ScalarImage blurred(const ScalarImage& image, double b, double ppd)
{
    const auto kernel = normalized(sensitivity(b, ppd));
    return filtered(image, kernel, kernel);
}

/// The blue-yellow sensitivity is a sum of two; the paper scales each by a √(π/b), before the whole is normalised.
ScalarImage blurred_blue_yellow(const ScalarImage& image, double ppd)
{
    constexpr std::array<double, 2> a{34.1, 13.5}, b{0.04, 0.025};
    std::array<double, 2> weight{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double s = sum_of(sensitivity(b[k], ppd));
        weight[k] = a[k] * std::sqrt(std::numbers::pi / b[k]) * s * s;
    }
    ScalarImage result = blurred(image, b[0], ppd);
    const ScalarImage second = blurred(image, b[1], ppd);
    const auto share = static_cast<float>(weight[0] / (weight[0] + weight[1]));
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        result.values[i] = share * result.values[i] + (1 - share) * second.values[i];
    }
    return result;
}

Planes seen_colors(const Image& image, double ppd)
{
    Planes planes;
    planes.fill(ScalarImage(image.width, image.height));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, planes[0].values.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const float* p = image.rgb.data() + 3 * i;
            const Vec3 c = opponent_of(glm::clamp(Rgb(p[0], p[1], p[2]), 0.0, 1.0));
            for (int k = 0; k < 3; ++k) planes[k].values[i] = static_cast<float>(c[k]);
        }
    });
    return {blurred(planes[0], 0.0047, ppd), blurred(planes[1], 0.0053, ppd), blurred_blue_yellow(planes[2], ppd)};
}

/// How strong an edge and a point the luminance has at each pixel.
struct Features {
    ScalarImage edge, point;
};

ScalarImage strength(const ScalarImage& luminance, const std::vector<float>& derivative, const std::vector<float>& g)
{
    ScalarImage result = filtered(luminance, derivative, g);
    const ScalarImage other = filtered(luminance, g, derivative);
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        result.values[i] = std::hypot(result.values[i], other.values[i]);
    }
    return result;
}

Features features_of(const Image& image, double ppd)
{
    ScalarImage Y(image.width, image.height);
    for (std::size_t i = 0; i < Y.values.size(); ++i) {
        const float* p = image.rgb.data() + 3 * i;
        Y.values[i] = static_cast<float>((xyz_of_rgb * glm::clamp(Rgb(p[0], p[1], p[2]), 0.0, 1.0)).y);
    }
    const double sigma = 0.5 * feature_width * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    const auto g = normalized(sampled(radius, gauss));
    const auto first = normalized_by_sign(sampled(radius, [&](double x) { return -x * gauss(x); }));
    const auto second =
        normalized_by_sign(sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gauss(x); }));
    return {strength(Y, first, g), strength(Y, second, g)};
}

void check(const Image& image)
{
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        if (!std::isfinite(image.rgb[i])) {
            const std::size_t pixel = i / 3, width = static_cast<std::size_t>(image.width);
            throw std::invalid_argument(fmt::format("the pixel at {}, {} is not finite", pixel % width, pixel / width));
        }
    }
}

}  // namespace

ScalarImage flip_map(const Image& a, const Image& b, double ppd)
{
    if (a.width != b.width || a.height != b.height || a.rgb.empty()) {
        throw std::invalid_argument(
            fmt::format("pictures of {}x{} and {}x{} can't be compared", a.width, a.height, b.width, b.height));
    }
    if (!(ppd >= 1 && ppd <= 1000)) throw std::invalid_argument("pixels per degree are 1 … 1000");
    check(a);
    check(b);
    const Planes ca = seen_colors(a, ppd), cb = seen_colors(b, ppd);
    const Features fa = features_of(a, ppd), fb = features_of(b, ppd);
    ScalarImage result(a.width, a.height);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.values.size(), 4096), [&](const auto& range) {
        const auto color_of = [](const Planes& p, std::size_t i) {
            const Rgb linear = linear_of({p[0].values[i], p[1].values[i], p[2].values[i]});
            return hunt_lab_of(glm::clamp(linear, 0.0, 1.0));
        };
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const double color = color_error(hyab(color_of(ca, i), color_of(cb, i)));
            const double edge = std::abs(double(fa.edge.values[i]) - double(fb.edge.values[i]));
            const double point = std::abs(double(fa.point.values[i]) - double(fb.point.values[i]));
            const double feature = std::pow(std::max(edge, point) * std::numbers::sqrt2 / 2, feature_exponent);
            result.values[i] = static_cast<float>(std::clamp(std::pow(color, 1 - feature), 0.0, 1.0));
        }
    });
    return result;
}

FlipSummary summary_of(const ScalarImage& flip)
{
    std::vector<float> sorted = flip.values;
    double sum = 0;
    for (const float value : sorted) sum += double(value);
    const std::size_t n = sorted.size(), rank = (95 * n + 99) / 100 - 1;
    const auto p95 = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), p95, sorted.end());
    return {sum / double(n), double(*p95), double(*std::max_element(p95, sorted.end()))};
}

}  // namespace patchlight
