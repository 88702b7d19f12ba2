#pragma once

#include "meshing/scene.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace patchlight {

/// How a file is understood.
struct SceneOptions {
    double unit = 1.0;                    ///< metres per unit of the file, > 0
    double max_reflectance = 0.95;        ///< used where a file says exactly 1; in (0, 1)
    double snap = 1e-8;                   ///< welding, coplanarity and contact tolerance × diameter
    bool all_two_sided = false;           ///< every material has two sides
    std::vector<std::string> two_sided;   ///< materials with two sides
    std::map<std::string, Rgb> emitters;  ///< exitance (W/m²) given to materials by name, in place of the file's
    bool require_emitter = true;          ///< a scene without light is an error
    bool join_objects = true;             ///< coplanar faces of one material join across objects, too
};

/// What reading found, mended and left out: `patchlight inspect` shows it.
struct SceneReport {
    std::string format;  ///< "obj" or "gltf"
    std::size_t vertices_read = 0;
    std::size_t faces_read = 0;
    std::size_t welded_vertices = 0;
    std::size_t zero_area_faces = 0;  ///< dropped: no wider than twice the snapping distance
    std::size_t duplicate_faces = 0;  ///< dropped
    std::size_t nonplanar_faces = 0;  ///< triangulated
    std::size_t self_crossing_faces = 0;
    std::size_t nonmanifold_edges = 0;
    std::size_t t_junctions = 0;
    std::size_t coplanar_overlaps = 0;       ///< pairs of faces of one plane that cover common area, same normal
    std::size_t opposed_pairs = 0;           ///< triangles of the arrangement with a surface on both sides
    std::size_t needles = 0;                 ///< faces more than 1e5 times longer than wide
    std::size_t crossing_faces = 0;          ///< pairs of faces that pierce each other
    double covered_area = 0;                 ///< m², from where every ray meets nothing but backs: no surface is there
    double snap_distance = 0;                ///< metres
    std::vector<std::string> empty_objects;  ///< names whose faces all have no area
    std::vector<std::string> warnings;       ///< whole sentences, in a fixed order
};

struct LoadedScene {
    Scene scene;
    SceneReport report;
};

/// Reads an OBJ (with its MTL) or a glTF 2.0 / GLB file, validates it, welds, joins coplanar adjacent faces of
/// one material and returns the scene. MTL Ke and glTF emissive are radiance: E = π·Ke.
/// Never opens a file outside the scene's folder. The order of faces in the file does not change the answer.
/// Throws SceneError for what pitfalls.md lists as exit 3.
LoadedScene read_scene(const std::filesystem::path& file, const SceneOptions& options = {});

}  // namespace patchlight
