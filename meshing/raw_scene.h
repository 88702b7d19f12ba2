#pragma once

#include "meshing/read_scene.h"
#include "meshing/scene.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// A face as a file gives it: `count` corners from `first_corner` on, counter-clockwise seen from its front.
struct RawFace {
    std::size_t first_corner = 0;
    std::size_t count = 0;
    MaterialId material;
    ObjectId object;
    std::size_t line = 0;  ///< of the file, from 1; 0 where the format has no lines
};

/// What a reader hands over before anything is checked or mended: indices may be past the end, coordinates not finite.
struct RawScene {
    std::string format;                     ///< "obj" or "gltf"
    std::string file_name;                  ///< as messages name it, without folders
    std::vector<Vec3> vertices;             ///< metres
    std::vector<std::size_t> vertex_lines;  ///< of the file, from 1; empty where the format has no lines
    std::vector<std::int64_t> corners;      ///< indices into vertices
    std::vector<RawFace> faces;
    std::vector<Material> materials;
    std::vector<std::string> objects;
    std::vector<View> views;              ///< positions in metres, not yet recentred
    double relative_precision = 0x1p-52;  ///< of the coordinates: 2^-23 when the file holds single precision
    std::vector<std::string> warnings;

    std::span<const std::int64_t> corners_of(const RawFace& face) const
    {
        return std::span(corners).subspan(face.first_corner, face.count);
    }
};

/// Reads an OBJ with its MTL files. Throws SceneError ("file", "nonfinite", "material").
RawScene read_obj(const std::filesystem::path& file, double unit);

/// Reads a glTF 2.0 or GLB file. Throws SceneError ("file", "gltf").
RawScene read_gltf(const std::filesystem::path& file, double unit);

/// Gives materials the emitters and second sides the options name, and mends or refuses their reflectances.
/// Throws SceneError("material").
void apply_material_options(RawScene& raw, const SceneOptions& options);

/// Refuses what can't be solved: indices past the end or below 0, coordinates that aren't finite in a vertex
/// that is used, reflectances outside [0, 1], no faces. Bad vertices that nothing uses become a warning.
/// Throws SceneError ("index", "nonfinite", "material", "empty").
void validate(RawScene& raw, const SceneOptions& options);

}  // namespace patchlight
