#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace patchlight {

/// The files of the Cornell box, by name: built into the program, so that the demo needs nothing beside it.
std::vector<std::pair<std::string_view, std::string_view>> demo_scene_files();

}  // namespace patchlight
