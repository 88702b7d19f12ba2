#pragma once

#include "meshing/scene.h"

#include <vector>

namespace patchlight {

/// The camera at t on a smooth path through cameras: at t = k it is keys[k], between them position, direction, up and
/// field of view follow a uniform Catmull-Rom curve [CatmullRom74], whose first and last keys count twice. t is cut to
/// 0 … keys − 1. Where directions cancel each other, the nearer key's is taken. There must be a key.
View view_on_path(const std::vector<View>& keys, double t);

}  // namespace patchlight
