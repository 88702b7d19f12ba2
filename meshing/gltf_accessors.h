#pragma once

#include "meshing/gltf_file.h"
#include "meshing/vectors.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// One primitive's triangles, in its own coordinates.
struct GltfTriangles {
    std::vector<Vec3> positions;  ///< those that triangles use, each once
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Whether all data of the primitive lie in buffers that were opened.
bool has_data(const GltfFile& gltf, const tinygltf::Primitive& primitive);

/// Reads positions and indices of a triangle list, strip or fan. `where` names the primitive in messages.
/// Throws SceneError ("gltf", "index") for accessors that reach past their buffer or aren't what they must be.
GltfTriangles read_triangles(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& where);

}  // namespace patchlight
