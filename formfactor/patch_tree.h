#pragma once

#include "meshing/patch_mesh.h"
#include "meshing/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// The patches in groups: leaves are up to `leaf_size` neighbours of one surface, above them halves of surfaces, above
/// these boxes of several surfaces.
struct PatchTree {
    struct Node {
        std::uint32_t first = 0, last = 0;   ///< range of `order`
        std::int32_t left = -1, right = -1;  ///< children; −1 in a leaf
        SurfaceId surface;                   ///< invalid where several are in it
        std::vector<Vec3> hull;              ///< corners of a rectangle in the surface's plane around all, or of a box
        bool is_leaf() const { return left < 0; }
    };

    std::vector<PatchId> order;         ///< patches, those of a node together
    std::vector<Node> nodes;            ///< the root is the last
    std::vector<std::uint32_t> leaves;  ///< in the order of their patches

    const Node& root() const { return nodes.back(); }
};

PatchTree patch_tree(const Scene& scene, const PatchMesh& mesh, std::size_t leaf_size = 32);

}  // namespace patchlight
