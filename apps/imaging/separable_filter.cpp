#include "apps/imaging/separable_filter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace patchlight {

namespace {

/// One row, with its ends repeated on both sides so that the inner loop needs no test.
void filter_row(const float* in, float* out, int width, const std::vector<float>& kernel, std::vector<float>& padded)
{
    const std::size_t radius = kernel.size() / 2, n = static_cast<std::size_t>(width);
    padded.resize(n + 2 * radius);
    std::fill_n(padded.begin(), radius, in[0]);
    std::copy_n(in, n, padded.data() + radius);
    std::fill_n(padded.data() + radius + n, radius, in[n - 1]);
    std::fill_n(out, n, 0.0F);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        for (std::size_t x = 0; x < n; ++x) out[x] += kernel[k] * padded[x + k];
    }
}

}  // namespace

std::vector<float> sampled(int radius, const std::function<double(double)>& f)
{
    std::vector<float> kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(static_cast<float>(f(x)));
    return kernel;
}

double sum_of(const std::vector<float>& kernel)
{
    return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

std::vector<float> normalized(std::vector<float> kernel)
{
    const double sum = sum_of(kernel);
    for (float& weight : kernel) weight = static_cast<float>(double(weight) / sum);
    return kernel;
}

std::vector<float> normalized_by_sign(std::vector<float> kernel)
{
    double positive = 0, negative = 0;
    for (const float weight : kernel) (weight > 0 ? positive : negative) += double(weight);
    for (float& weight : kernel) {
        if (weight != 0) weight = static_cast<float>(double(weight) / (weight > 0 ? positive : -negative));
    }
    return kernel;
}

ScalarImage filtered(const ScalarImage& image, const std::vector<float>& kernel_x, const std::vector<float>& kernel_y)
{
    ScalarImage across(image.width, image.height), result(image.width, image.height);
    const auto rows = tbb::blocked_range<int>(0, image.height, 16);
    tbb::parallel_for(rows, [&](const auto& range) {
        std::vector<float> padded;
        for (int y = range.begin(); y < range.end(); ++y) {
            filter_row(&image.values[0] + std::ptrdiff_t(y) * image.width, &across.at(0, y), image.width, kernel_x,
                       padded);
        }
    });
    const int radius = static_cast<int>(kernel_y.size() / 2);
    tbb::parallel_for(rows, [&](const auto& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            float* const out = &result.at(0, y);
            for (int k = -radius; k <= radius; ++k) {
                const float* const in =
                    across.values.data() + std::ptrdiff_t(std::clamp(y + k, 0, image.height - 1)) * image.width;
                const float weight = kernel_y[static_cast<std::size_t>(k + radius)];
                for (int x = 0; x < image.width; ++x) out[x] += weight * in[x];
            }
        }
    });
    return result;
}

}  // namespace patchlight
