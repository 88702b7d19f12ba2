#include "meshing/gltf_nodes.h"

#include "meshing/scene_error.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <algorithm>

namespace patchlight {

namespace {

glm::dmat4 rotation(const std::vector<double>& q)
{
    const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const double s = length2 > 0 ? 2 / length2 : 0;
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    glm::dmat4 m(1.0);
    m[0] = {1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y), 0};
    m[1] = {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x), 0};
    m[2] = {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y), 0};
    return m;
}

glm::dmat4 local_transform(const tinygltf::Node& node)
{
    glm::dmat4 m(1.0);
    if (node.matrix.size() == 16) {
        for (int k = 0; k < 16; ++k) m[k / 4][k % 4] = node.matrix[static_cast<std::size_t>(k)];
        return m;
    }
    if (node.rotation.size() == 4) m = rotation(node.rotation);
    if (node.scale.size() == 3) {
        for (int k = 0; k < 3; ++k) m[k] *= node.scale[static_cast<std::size_t>(k)];
    }
    if (node.translation.size() == 3) m[3] = {node.translation[0], node.translation[1], node.translation[2], 1};
    return m;
}

std::vector<std::size_t> roots(const GltfFile& gltf)
{
    const tinygltf::Model& model = gltf.model;
    std::vector<std::size_t> result;
    if (!model.scenes.empty()) {
        const auto chosen = static_cast<std::size_t>(std::max(model.defaultScene, 0));
        if (chosen >= model.scenes.size()) {
            throw SceneError("gltf", fmt::format("{}: scene {} of {}", gltf.name, chosen, model.scenes.size()));
        }
        for (const int node : model.scenes[chosen].nodes) result.push_back(static_cast<std::size_t>(node));
        return result;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
        }
    }
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (!is_child[n]) result.push_back(n);
    }
    // Every node somebody's child: a cycle, which the walk will name.
    if (result.empty() && !model.nodes.empty()) result.push_back(0);
    return result;
}

}  // namespace

bool PlacedNode::mirrored() const
{
    return glm::determinant(glm::dmat3(to_world)) < 0;
}

std::vector<PlacedNode> place_nodes(const GltfFile& gltf, std::vector<std::string>& warnings)
{
    const auto& nodes = gltf.model.nodes;
    std::vector<bool> visited(nodes.size(), false);
    std::vector<PlacedNode> placed;
    const auto add = [&](std::size_t index, const glm::dmat4& parent) {
        if (index >= nodes.size()) {
            throw SceneError("gltf",
                             fmt::format("{}: node {} of {}", gltf.name, static_cast<int>(index), nodes.size()));
        }
        if (visited[index]) {
            throw SceneError("gltf", fmt::format("{}: node {} has two parents or lies in a cycle", gltf.name, index));
        }
        visited[index] = true;
        placed.push_back({index, parent * local_transform(nodes[index])});
    };
    for (const std::size_t root : roots(gltf)) add(root, glm::dmat4(1.0));
    for (std::size_t next = 0; next < placed.size(); ++next) {
        const PlacedNode parent = placed[next];
        for (const int child : nodes[parent.index].children) add(static_cast<std::size_t>(child), parent.to_world);
    }
    if (placed.size() < nodes.size()) {
        warnings.push_back(fmt::format("{}: {} nodes are not part of the scene and are ignored", gltf.name,
                                       nodes.size() - placed.size()));
    }
    return placed;
}

}  // namespace patchlight
