#pragma once

#include "solver/system.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// Where the light goes that reaches no patch's front, W, three bands together.
struct LostLight {
    double escaped = 0;  ///< met nothing
    double backs = 0;    ///< met black backs
};

/// Of B sent out by all patches: by rays in proportion to what each sends, cosine-weighted [Malley88]. For solvers that
/// have no rows that say it. Relative to all power sent the standard error is ½/√rays at most. The same on any number
/// of threads.
LostLight lost_light(const Exchange& exchange, const Radiosity& B, std::size_t rays = 65536, std::uint64_t seed = 1);

/// By surface, 1: some ray, of 32 random ones from each surface, leads by way of others to one that emits. Light goes
/// both ways along a ray; 0 is what rays know, no proof of darkness.
std::vector<std::uint8_t> lit_surfaces(const Exchange& exchange, std::uint64_t seed = 1);

}  // namespace patchlight
