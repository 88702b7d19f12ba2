#pragma once

#include "apps/imaging/image.h"
#include "apps/imaging/scalar_image.h"

#include <string>
#include <vector>

namespace patchlight {

/// A picture with a line of text under it.
struct Captioned {
    const Image& picture;  ///< sRGB
    std::string title;     ///< large
    std::string detail;    ///< smaller, below
};

/// Pictures in a row with their captions, on a dark ground. Without a font the captions are left out.
Image in_a_row(const std::vector<Captioned>& pictures);
Image side_by_side(const Captioned& left, const Captioned& right);

/// The left half of one picture and the right half of the other, with a white line between them. Throws
/// std::invalid_argument when their sizes differ, as the functions below do.
Image wiped(const Image& left, const Image& right);

/// Of radiance: |A − B| in each band, or A − B, both weighed as luminance; W/(m²·sr).
ScalarImage absolute_difference(const Image& a, const Image& b);
ScalarImage signed_difference(const Image& a, const Image& b);

/// √ of the mean square of A − B over pixels and bands.
double root_mean_square(const Image& a, const Image& b);

}  // namespace patchlight
