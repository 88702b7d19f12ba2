#pragma once

#include "meshing/scene_files.h"

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace patchlight {

/// A glTF file read, but not yet understood.
struct GltfFile {
    std::string name;  ///< as messages name it
    SceneFolder folder;
    tinygltf::Model model;             ///< without its images
    nlohmann::json images;             ///< the document's array of images, to be read when a material asks for them
    std::vector<bool> buffer_refused;  ///< by buffer: its file lies outside the scene's folder and wasn't opened
    std::vector<std::string> required_extensions;
    std::vector<std::string> warnings;
};

/// Reads a .gltf or .glb. Nothing outside the scene's folder is opened. Lengths are checked before anything is
/// allocated for them. Throws SceneError ("file", "gltf").
GltfFile load_gltf(const std::filesystem::path& file);

/// A URI with its %xx replaced.
std::string percent_decoded(const std::string& uri);

}  // namespace patchlight
