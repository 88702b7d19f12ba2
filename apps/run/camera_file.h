#pragma once

#include "meshing/scene.h"

#include <filesystem>
#include <vector>

namespace patchlight {

/// The cameras of a JSON file: an object {name, from, to or forward, up, fov}, or an array of such. Coordinates are
/// those of the scene's file; fov is vertical, in degrees. Throws std::invalid_argument with the file and the cause.
std::vector<View> read_cameras(const std::filesystem::path& file, const Scene& scene);

/// Those of STEM.view.json beside the scene's file; none when it isn't there. Throws as read_cameras.
std::vector<View> cameras_beside(const std::filesystem::path& scene_file, const Scene& scene);

}  // namespace patchlight
