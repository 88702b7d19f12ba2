#include "apps/run/element_nodes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace patchlight {

namespace {

/// Makes the nodes in the middles of edges, each once.
class MiddleNodes {
public:
    explicit MiddleNodes(ElementNodes& nodes) : nodes_(nodes) {}

    /// A middle with a light of its own is another node, should two patches not agree.
    std::uint32_t at(VertexId a, VertexId b, const Rgb& B)
    {
        const auto [node, is_new] =
            known_.try_emplace(std::minmax({a.value, b.value}), static_cast<std::uint32_t>(nodes_.positions.size()));
        if (!is_new && nodes_.B[node->second] == B) return node->second;
        nodes_.positions.push_back(0.5 * (nodes_.positions[a.value] + nodes_.positions[b.value]));
        nodes_.B.push_back(B);
        return static_cast<std::uint32_t>(nodes_.positions.size() - 1);
    }

private:
    ElementNodes& nodes_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known_;
};

}  // namespace

ElementNodes element_nodes(const StoredSolution& solution)
{
    const PatchMesh& mesh = solution.mesh;
    const bool quadratic = !solution.middle_B.empty();
    ElementNodes nodes;
    nodes.per_patch = quadratic ? 6 : 3;
    for (const VertexId v : mesh.vertices()) {
        nodes.positions.push_back((mesh.position(v) + solution.scene.center) / solution.scene.unit);
        nodes.B.push_back(solution.vertex_B[v]);
    }
    MiddleNodes middles(nodes);
    nodes.of_patches.reserve(nodes.per_patch * mesh.patch_count());
    for (const PatchId patch : mesh.patches()) {
        const auto corners = mesh.corners(patch);
        for (const VertexId corner : corners) nodes.of_patches.push_back(corner.value);
        for (std::size_t k = 0; quadratic && k < 3; ++k) {
            nodes.of_patches.push_back(middles.at(corners[k], corners[(k + 1) % 3], solution.middle_B[patch][k]));
        }
    }
    return nodes;
}

}  // namespace patchlight
