#include "meshing/read_scene.h"

#include "meshing/build_scene.h"
#include "meshing/raw_scene.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace patchlight {

namespace {

RawScene read_raw(const std::filesystem::path& file, double unit)
{
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending == ".obj") return read_obj(file, unit);
    if (ending == ".gltf" || ending == ".glb") return read_gltf(file, unit);
    throw SceneError("format", fmt::format("{}: unknown format {}, known are .obj, .gltf and .glb", file.string(),
                                           ending.empty() ? "(no ending)" : ending));
}

}  // namespace

LoadedScene read_scene(const std::filesystem::path& file, const SceneOptions& options)
{
    RawScene raw = read_raw(file, options.unit);
    validate(raw, options);
    LoadedScene loaded = build_scene(raw, options);
    loaded.scene.name = file.filename().string();
    return loaded;
}

}  // namespace patchlight
