#pragma once

#include "meshing/scene.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// By surface, the shell that its front is part of (see SpaceRegions): fronts that meet at edges, going round them, are
/// of one shell; sealed rooms that touch are not. Triangles meet where their vertices have the same coordinates.
std::vector<std::uint32_t> surface_shells(const Scene& scene);

}  // namespace patchlight
