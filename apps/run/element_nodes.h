#pragma once

#include "apps/run/stored_solution.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace patchlight {

/// The nodes at which a solution has its light: the mesh's vertices, in order, then, of quadratic elements, the middles
/// of edges. Patches share the node of a common edge, except across a contact line, where the mesh is cut open.
struct ElementNodes {
    std::vector<Vec3> positions;  ///< in the scene file's coordinates and units
    std::vector<Rgb> B;           ///< W/m²
    std::size_t per_patch = 3;    ///< 3, or 6: corners, then the middles of edges 01, 12, 20
    std::vector<std::uint32_t> of_patches;
};

ElementNodes element_nodes(const StoredSolution& solution);

}  // namespace patchlight
