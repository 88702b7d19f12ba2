#pragma once

#include "meshing/scene.h"
#include "meshing/scene_files.h"

#include <map>
#include <string>
#include <vector>

namespace patchlight {

/// The materials of an OBJ's MTL files, by name. The first of two with one name counts.
struct MtlLibrary {
    std::map<std::string, Material> materials;
    std::vector<std::string> warnings;
};

/// Reads one MTL file's text: Kd is the reflectance, Ke radiance (E = π·Ke); textures, transparency and gloss are
/// left out with a warning. Throws SceneError("material") where Kd or Ke isn't made of finite numbers.
void read_mtl(const std::string& text, const std::string& file_name, MtlLibrary& library);

/// Reads the files that an mtllib line names, from the scene's folder only: what is missing, or leaves it, is a
/// warning.
void read_material_files(const std::string& names, const SceneFolder& folder, const std::string& obj_name,
                         MtlLibrary& library);

}  // namespace patchlight
