#pragma once

#include "apps/imaging/scalar_image.h"

#include <functional>
#include <vector>

namespace patchlight {

/// f at −radius … radius, whole steps: 2 radius + 1 weights.
std::vector<float> sampled(int radius, const std::function<double(double)>& f);

double sum_of(const std::vector<float>& kernel);
/// Scaled so that the weights sum to 1.
std::vector<float> normalized(std::vector<float> kernel);
/// The positive weights scaled to sum to 1, the negative ones to −1.
std::vector<float> normalized_by_sign(std::vector<float> kernel);

/// The correlation with kernel_x ⊗ kernel_y, both of odd length: out(x, y) = Σ kernel_x[i] kernel_y[j] in(x + i − r,
/// y + j − r). Beyond the border the border's pixels go on. The same bits at any number of threads.
ScalarImage filtered(const ScalarImage& image, const std::vector<float>& kernel_x, const std::vector<float>& kernel_y);

}  // namespace patchlight
