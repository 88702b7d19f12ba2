#pragma once

#include "written_scene.h"

#include <algorithm>

/// Blocks and plates on a floor, and what must hold of all that touches or crosses.
namespace patchlight::testing {

inline const Polygon floor_below = rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

/// A 4 × 4 m floor under a lamp.
inline std::vector<Polygon> lit_floor(const std::vector<Polygon>& more)
{
    return with({lamp_above, floor_below}, more);
}

inline std::vector<Polygon> red_box(const Vec3& low, const Vec3& size, bool bottom = true)
{
    auto sides = box(low, size, false, "red", "block");
    if (!bottom) sides.erase(sides.begin());
    return sides;
}

inline Vec3 normal_of(const Polygon& p)
{
    return glm::normalize(glm::cross(p.corners[1] - p.corners[0], p.corners[2] - p.corners[0]));
}

/// Brute force: no edge of the scene's triangles passes through another triangle, further than snapping from its
/// border: what meets shares vertices.
inline void expect_nothing_pierced(const LoadedScene& loaded)
{
    const Scene& scene = loaded.scene;
    const double margin = 4 * loaded.report.snap_distance;
    const auto at = [&](std::uint32_t v) { return scene.vertices[v]; };
    std::size_t pierced = 0;
    for (const SceneTriangle& sheet : scene.triangles) {
        const Vec3 a = at(sheet.vertices[0]), b = at(sheet.vertices[1]), c = at(sheet.vertices[2]);
        const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
        for (const SceneTriangle& needle : scene.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 p = at(needle.vertices[k]), q = at(needle.vertices[(k + 1) % 3]);
                const double h = glm::dot(p - a, n), g = glm::dot(q - a, n);
                if (std::min(h, g) > -margin || std::max(h, g) < margin) continue;
                const Vec3 x = p + h / (h - g) * (q - p);
                const auto inside = [&](const Vec3& u, const Vec3& w) {
                    return glm::dot(glm::cross(w - u, x - u), n) > margin * glm::distance(u, w);
                };
                pierced += inside(a, b) && inside(b, c) && inside(c, a);
            }
        }
    }
    EXPECT_EQ(pierced, 0U);
}

}  // namespace patchlight::testing
