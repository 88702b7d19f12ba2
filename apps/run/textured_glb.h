#pragma once

#include "meshing/scene.h"

#include <functional>
#include <string>

namespace patchlight {

/// The scene's surfaces as a binary glTF 2.0 file with texture coordinates: what `texture_at` says of a surface at
/// plane coordinates, from the picture's upper left corner, (0, 0), to its lower right, (1, 1). Triangles are those of
/// the surfaces, not the patches. glTF takes no EXR for a texture, so the picture's `file` name stands in extras.
/// Materials are lit ones (base colour: the reflectance), for the picture brings the light along.
std::string encode_textured_glb(const Scene& scene,
                                const std::function<Vec2(SurfaceId surface, const Vec2& q)>& texture_at,
                                const std::string& file);

}  // namespace patchlight
