#pragma once

#include "meshing/gltf_file.h"
#include "meshing/vectors.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace patchlight {

/// A node with its place in the world.
struct PlacedNode {
    std::size_t index = 0;
    glm::dmat4 to_world{1.0};

    Vec3 place(const Vec3& p) const { return Vec3(to_world * glm::dvec4(p, 1)); }
    Vec3 direction(const Vec3& d) const { return glm::dmat3(to_world) * d; }
    bool mirrored() const;
};

/// The nodes of the default scene (without one: of all), parents before children. Warns of nodes left out.
/// Throws SceneError("gltf") for cycles, nodes with two parents and indices past the end.
std::vector<PlacedNode> place_nodes(const GltfFile& gltf, std::vector<std::string>& warnings);

}  // namespace patchlight
