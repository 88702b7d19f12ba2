#pragma once

#include <vector>

namespace patchlight {

/// An animated PNG that runs for ever, of frames that encode_png made: each of them as it is, in full colour. Viewers
/// that know no animations show the first. Every frame stays `milliseconds` (1 … 65535); the last one three times as
/// long. Throws std::invalid_argument without frames, when they differ in size or kind, or aren't PNGs.
std::vector<unsigned char> encode_animation(const std::vector<std::vector<unsigned char>>& frames, int milliseconds);

}  // namespace patchlight
