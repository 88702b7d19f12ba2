#pragma once

#include "apps/imaging/image.h"
#include "apps/imaging/scalar_image.h"

namespace patchlight {

/// The paper's monitor: 0.7 m wide, 3840 pixels, seen from 0.7 m; pixels per degree of visual angle.
inline constexpr double flip_pixels_per_degree = 67.02064327658226;

/// LDR-FLIP [Andersson20]: for each pixel how much of a difference an observer sees who flips between two pictures on a
/// screen, 0 (none) … 1. The pictures are linear Rec. 709; values are cut to [0, 1], as a screen would. Exchanging
/// the two changes nothing. Beyond the border the border's pixels go on.
///
/// Colours are filtered by the eye's contrast sensitivity in YCxCz and compared by HyAB in L*a*b* with Hunt's
/// adjustment (exponent .7, .4 of the largest distance mapped to .95); edges and points of the luminance are compared
/// by derivatives of Gaussians (.082°), and ΔE = ΔE_colour^(1 − ΔE_feature). The exponents are the paper's. Black
/// against white is .967; only green against blue is 1.
///
/// Throws std::invalid_argument when sizes differ, when there is no pixel, when pixels_per_degree isn't between 1 and
/// 1000, or for a pixel that isn't finite, which it names: such a pixel has no colour that could be compared.
ScalarImage flip_map(const Image& a, const Image& b, double pixels_per_degree = flip_pixels_per_degree);

struct FlipSummary {
    double mean = 0;
    double p95 = 0;  ///< the smallest value that at least 95 % of the pixels don't exceed
    double max = 0;
};

/// Of a map with at least one pixel.
FlipSummary summary_of(const ScalarImage& flip);

}  // namespace patchlight
