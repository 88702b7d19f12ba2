#pragma once

#include "formfactor/ray_caster.h"
#include "meshing/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// The cameras of a JSON file: an object {name, from, to or forward, up, fov}, or an array of such. Coordinates are
/// those of the scene's file; fov is vertical, in degrees. Throws UsageError ("view") with the file and the cause.
std::vector<View> read_views(const std::filesystem::path& file, const Scene& scene);

/// Those of STEM.view.json beside the scene's file; none when it isn't there.
std::vector<View> views_beside(const std::filesystem::path& scene_file, const Scene& scene);

/// The camera meant by --view: the scene's camera of that name, or the first of a file; without --view the scene's
/// first camera, or default_view. Throws UsageError ("view").
View chosen_view(const std::string& wanted, const Scene& scene, const RayCaster& caster);

/// The camera of a scene by name. Throws UsageError ("view") that lists them.
View view_named(const std::string& name, const Scene& scene);

/// The pictures' size: as asked, or 640 high and as wide as the camera says.
std::pair<int, int> picture_size(const std::optional<std::pair<int, int>>& asked, const View& view);

}  // namespace patchlight
