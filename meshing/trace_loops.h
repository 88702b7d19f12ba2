#pragma once

#include "meshing/scene.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace patchlight {

/// The loops that bound a region, from its directed border edges (region on the left): the outer loop first,
/// counter-clockwise in `frame`, then the holes, clockwise. No loop passes a vertex twice. Vertices that lie
/// within `snap` of the line between the corners around them are left out, unless several loops meet there.
/// Each loop starts at its smallest vertex; holes are in ascending order.
std::vector<std::vector<std::uint32_t>> trace_loops(std::vector<std::pair<std::uint32_t, std::uint32_t>> border,
                                                    const PlaneFrame& frame, const std::vector<Vec3>& vertices,
                                                    double snap);

}  // namespace patchlight
