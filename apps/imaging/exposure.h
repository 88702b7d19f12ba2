#pragma once

#include "apps/imaging/picture.h"

namespace patchlight {

/// The exposure, in stops, that shows what doesn't emit well: 2^EV times the 90th percentile of its luminance
/// (B/π in W/(m²·sr), of the pixels of `radiance`) is half of white. 0 when nothing is lit. `radiance` must have
/// one sample a pixel and belong to `hits`.
double auto_exposure(const Scene& scene, const ViewHits& hits, const Image& radiance);

/// The radiance that is white at an exposure.
double white_at(double exposure);

/// Linear radiance × 2^EV, cut at 1, as sRGB values between 0 and 1.
Image to_srgb(const Image& radiance, double exposure);

/// The sRGB curve, and back.
double srgb_encoded(double linear);
double srgb_decoded(double encoded);

}  // namespace patchlight
