#pragma once

#include "meshing/scene.h"
#include "meshing/surface_line.h"

#include <vector>

namespace patchlight {

/// Lines of one surface and one line that overlap or touch become one; where kinds differ, the stronger keeps what it
/// covers and the weaker the rest: contact, plane, EV, VE, EEE. What runs along the surface's own border, and
/// pieces shorter than 16 × snap, go. Ends and distances within 4 × snap (m) of each other are the same.
/// Sorted by surface, start, end; the order of `lines` does not matter.
std::vector<SurfaceLine> merged_lines(const Scene& scene, std::vector<SurfaceLine> lines, double snap);

}  // namespace patchlight
