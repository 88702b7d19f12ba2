#pragma once

#include "apps/run/byte_views.h"
#include "meshing/scene.h"

#include <string>
#include <string_view>

namespace patchlight {

/// Adds the whole scene to `views`, under names that begin with "scene_".
void store_scene(const Scene& scene, ByteViews& views);

/// The scene that was stored, equal to the bit. Throws SceneError ("solution") when an array is missing, cut
/// short, or an index leaves its array.
Scene restore_scene(const ByteViews& views);

/// SHA-256 over everything in the scene, whatever files it came from: tells a changed MTL or buffer too.
std::string scene_digest(const Scene& scene);

/// The text with whatever isn't UTF-8 replaced, for JSON takes nothing else.
std::string as_utf8(const std::string& text);

/// How deeply brackets are nested in a JSON text. To be asked before a recursive parser reads an untrusted one.
std::size_t json_depth(std::string_view text);

}  // namespace patchlight
