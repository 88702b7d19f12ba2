#include "meshing/raw_scene.h"
#include "meshing/scene_error.h"

namespace patchlight {

RawScene read_gltf(const std::filesystem::path& file, double)
{
    throw SceneError("format", file.string() + ": glTF is not read yet");
}

}  // namespace patchlight
