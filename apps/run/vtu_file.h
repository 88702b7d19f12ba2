#pragma once

#include "apps/run/stored_solution.h"

#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// The mesh and its light as a VTK unstructured grid (.vtu: XML with the arrays appended raw, little endian, lengths in
/// 64 bits), for ParaView and VTK. Points are in the scene file's coordinates, with their radiosity in W/m² (two on a
/// contact line, one a side). Cells are triangles, or quadratic triangles when the solution has light in the middles of
/// edges, and have: radiosity, the patch's mean, W/m²; error, the indicator, W/m²·m; area, m²; surface and material,
/// numbers; level, log2 of surface area over patch area, rounded: how often a surface was halved to get there.
std::string encode_vtu(const StoredSolution& solution);

/// A series of such files (.pvd): the numbers of the cycles are its time.
std::string encode_pvd(const std::vector<std::pair<int, std::string>>& files);

}  // namespace patchlight
