#pragma once

#include "meshing/raw_scene.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// A planar polygon over welded vertices: at least three corners, wider than the snapping distance.
struct SoupFace {
    std::vector<std::uint32_t> loop;  ///< starts at its smallest index; may cross itself
    MaterialId material;
    ObjectId object;
    Vec3 normal{0.0};  ///< unit, of the front
    double area = 0;   ///< m², of the loop; parts that run the other way round count negative
};

/// Welded vertices and mended faces, both in an order that depends on their geometry only.
struct PolygonSoup {
    Vec3 center{0.0};
    double diameter = 0;
    double snap = 0;                   ///< metres
    std::vector<Vec3> vertices;        ///< recentred, sorted by x, y, z
    std::vector<SoupFace> faces;       ///< sorted by their loops
    std::vector<Material> materials;   ///< those that faces use, sorted by name
    std::vector<std::string> objects;  ///< sorted by name
};

/// Recentres, welds vertices within the snapping distance, drops faces without area and duplicates, and cuts
/// faces that aren't planar into triangles. Throws SceneError("zeroarea") when no face is left, "size"
/// when the scene is less than 1e-15 or more than 1e15 m across.
PolygonSoup make_polygon_soup(const RawScene& raw, const SceneOptions& options, SceneReport& report);

}  // namespace patchlight
