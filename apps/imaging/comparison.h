#pragma once

#include "apps/imaging/image.h"

#include <string>

namespace patchlight {

/// A picture with a line of text under it.
struct Captioned {
    const Image& picture;  ///< sRGB
    std::string title;     ///< large
    std::string detail;    ///< smaller, below
};

/// Two pictures side by side with their captions, on a dark ground. Without a font the captions are left out.
Image side_by_side(const Captioned& left, const Captioned& right);

}  // namespace patchlight
