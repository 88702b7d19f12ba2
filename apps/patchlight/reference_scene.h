#pragma once

#include "formfactor/reference_cases.h"
#include "meshing/scene.h"

namespace patchlight {

/// A reference pair as a scene, by the way that every file goes: its objects are "from", "to" and "blocker".
Scene reference_scene(const ReferencePair& pair);

/// The object of that name in a reference scene.
ObjectId reference_object(const Scene& scene, const std::string& name);

}  // namespace patchlight
