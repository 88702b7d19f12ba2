#pragma once

#include <cstdint>

namespace patchlight {

/// How light is gathered at points: emitters by Lambert's formula times the visible fraction, the rest by rays
/// over the hemisphere that bring B of the patches they meet.
struct GatherOptions {
    int rays = 256;              ///< over the hemisphere, 16 … 65536
    int shadow_rays = 256;       ///< per emitter, where it is partly hidden, 16 … 65536
    double crease_angle = 30;    ///< degrees: facets of one material that meet at less share irradiance at common vertices
    std::uint64_t seed = 1;
};

}  // namespace patchlight
