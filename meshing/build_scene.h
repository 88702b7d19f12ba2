#pragma once

#include "meshing/raw_scene.h"

namespace patchlight {

/// Makes the scene of what a reader brought and validate() let pass: welded, split where faces touch, joined
/// into surfaces. Throws SceneError ("zeroarea", "dark"; "size" and "material" when lengths or the brightest exitance
/// are beyond what can be computed with).
LoadedScene build_scene(const RawScene& raw, const SceneOptions& options);

}  // namespace patchlight
