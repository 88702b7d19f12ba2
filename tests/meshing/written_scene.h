#pragma once

#include "meshing/read_scene.h"
#include "meshing/scene_error.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace patchlight::testing {

inline const std::string three_materials = R"(newmtl white
Kd .7 .7 .7
newmtl red
Kd .6 .1 .1
newmtl lamp
Kd 0 0 0
Ke 10 10 10
)";

/// A polygon of a scene made in code: its corners are its own, nothing is shared.
struct Polygon {
    std::vector<Vec3> corners;
    std::string material = "white";
    std::string object = "thing";
};

using Placement = std::function<Vec3(const Vec3&)>;

inline std::string obj_text(const std::vector<Polygon>& polygons, const Placement& place = {})
{
    std::string text = "mtllib scene.mtl\n";
    std::size_t count = 0;
    for (const Polygon& polygon : polygons) {
        std::string face = "f";
        for (const Vec3& corner : polygon.corners) {
            const Vec3 p = place ? place(corner) : corner;
            text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
            face += fmt::format(" {}", ++count);
        }
        text += fmt::format("o {}\nusemtl {}\n{}\n", polygon.object, polygon.material, face);
    }
    return text;
}

inline LoadedScene read_text(const std::string& obj, const SceneOptions& options = {},
                             const std::string& mtl = three_materials)
{
    const TemporaryFolder folder;
    folder.write("scene.mtl", mtl);
    return read_scene(folder.write("scene.obj", obj), options);
}

inline LoadedScene load(const std::vector<Polygon>& polygons, const SceneOptions& options = {},
                        const Placement& place = {})
{
    return read_text(obj_text(polygons, place), options);
}

/// The rectangle a, a+u, a+u+v, a+v: front along u × v.
inline Polygon rectangle(const Vec3& a, const Vec3& u, const Vec3& v, const std::string& material = "white",
                         const std::string& object = "thing")
{
    return {{a, a + u, a + u + v, a + v}, material, object};
}

inline std::vector<Polygon> with(std::vector<Polygon> polygons, const std::vector<Polygon>& more)
{
    polygons.insert(polygons.end(), more.begin(), more.end());
    return polygons;
}

inline std::vector<Polygon> with(std::vector<Polygon> polygons, const Polygon& more)
{
    polygons.push_back(more);
    return polygons;
}

/// The six sides of a box, fronts inside or outside.
inline std::vector<Polygon> box(const Vec3& low, const Vec3& size, bool inside, const std::string& material = "white",
                                const std::string& object = "box")
{
    const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    std::vector<Polygon> sides = {rectangle(low, x, y, material, object), rectangle(low + z, y, x, material, object),
                                  rectangle(low, y, z, material, object), rectangle(low + x, z, y, material, object),
                                  rectangle(low, z, x, material, object), rectangle(low + y, x, z, material, object)};
    if (!inside) {
        for (Polygon& side : sides) std::reverse(side.corners.begin(), side.corners.end());
    }
    return sides;
}

/// A room of 4 × 4 × 3 m with a 1 × 1 lamp let into its ceiling.
inline std::vector<Polygon> room_with_lamp()
{
    std::vector<Polygon> room = box({0, 0, 0}, {4, 4, 3}, true, "white", "room");
    room.erase(room.begin() + 1);
    const auto ceiling = [&](const Vec3& a, const Vec3& u, const Vec3& v) {
        room.push_back(rectangle(a, u, v, "white", "ceiling"));
    };
    ceiling({0, 0, 3}, {0, 4, 0}, {1, 0, 0});
    ceiling({2, 0, 3}, {0, 4, 0}, {2, 0, 0});
    ceiling({1, 0, 3}, {0, 1, 0}, {1, 0, 0});
    ceiling({1, 2, 3}, {0, 2, 0}, {1, 0, 0});
    room.push_back(rectangle({1, 1, 3}, {0, 1, 0}, {1, 0, 0}, "lamp", "lamp"));
    return room;
}

inline const Polygon lamp_above = rectangle({-1, -1, 9}, {0, 1, 0}, {1, 0, 0}, "lamp", "lamp");

/// A rotation about no axis in particular.
inline Vec3 rotated(const Vec3& p)
{
    const Vec3 axis = glm::normalize(Vec3{0.3, -0.7, 0.55});
    const double angle = 0.83;
    return p * std::cos(angle) + glm::cross(axis, p) * std::sin(angle) +
           axis * glm::dot(axis, p) * (1 - std::cos(angle));
}

inline double triangle_area(const Scene& scene, const SceneTriangle& t)
{
    const Vec3& a = scene.vertices[t.vertices[0]];
    return 0.5 * glm::length(glm::cross(scene.vertices[t.vertices[1]] - a, scene.vertices[t.vertices[2]] - a));
}

inline double loop_area(const Scene& scene, const Surface& surface, const std::vector<std::uint32_t>& loop)
{
    double twice = 0;
    const auto at = [&](std::size_t k) { return surface.frame.to_plane(scene.vertices[loop[k]]); };
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) twice += cross2(at(0), at(k), at(k + 1));
    return 0.5 * twice;
}

/// What must hold of every scene, whatever was read.
inline void expect_sound(const LoadedScene& loaded)
{
    const Scene& scene = loaded.scene;
    const double snap = loaded.report.snap_distance;
    std::vector<double> areas(scene.surfaces.size(), 0.0);
    double covered = 0;
    for (const SceneTriangle& t : scene.triangles) {
        covered += t.front.valid() || t.back.valid() ? 0 : triangle_area(scene, t);
        const Vec3& a = scene.vertices[t.vertices[0]];
        const Vec3 n = glm::cross(scene.vertices[t.vertices[1]] - a, scene.vertices[t.vertices[2]] - a);
        for (const SurfaceId side : {t.front, t.back}) {
            if (!side.valid()) continue;
            areas.at(side.value) += triangle_area(scene, t);
            // Slivers thinner than snapping have no normal to speak of.
            if (glm::length(n) > 10 * snap * scene.diameter) {
                EXPECT_GT(glm::dot(n, scene.surface(side).frame.n) * (side == t.front ? 1 : -1), 0);
            }
        }
    }
    EXPECT_LE(covered, loaded.report.covered_area * (1 + 1e-12) + 1e-14 * scene.diameter * scene.diameter)
        << "only covered triangles are black on both sides";
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Surface& surface = scene.surfaces[s];
        const PlaneFrame& frame = surface.frame;
        EXPECT_NEAR(glm::length(glm::cross(frame.u, frame.v) - frame.n), 0, 1e-14);
        // Slivers cancel: their areas are exact to the rounding of the products they are made of.
        const double rounding = 1e-12 * surface.area + 1e-15 * scene.diameter * scene.diameter;
        EXPECT_NEAR(areas[s], surface.area, rounding);
        ASSERT_FALSE(surface.loops.empty());
        double area = 0, perimeter = 0;
        for (std::size_t l = 0; l < surface.loops.size(); ++l) {
            const auto& loop = surface.loops[l];
            ASSERT_GE(loop.size(), 3U);
            const double signed_area = loop_area(scene, surface, loop);
            EXPECT_EQ(signed_area > 0, l == 0) << "outer loop counter-clockwise, holes clockwise";
            area += signed_area;
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec3& p = scene.vertices.at(loop[k]);
                EXPECT_LE(std::abs(glm::dot(p - frame.origin, frame.n)), 2.1 * snap);
                perimeter += glm::distance(p, scene.vertices[loop[(k + 1) % loop.size()]]);
            }
        }
        // Vertices left out of the loops, and seams, may lie the snapping distance off a straight border.
        EXPECT_NEAR(area, surface.area, 4 * snap * perimeter + rounding);
    }
}

inline void expect_same_scene(const Scene& a, const Scene& b)
{
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.objects, b.objects);
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
        EXPECT_EQ(a.triangles[t].vertices, b.triangles[t].vertices);
        EXPECT_EQ(a.triangles[t].front, b.triangles[t].front);
        EXPECT_EQ(a.triangles[t].back, b.triangles[t].back);
    }
    ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
    for (std::size_t s = 0; s < a.surfaces.size(); ++s) {
        EXPECT_EQ(a.surfaces[s].loops, b.surfaces[s].loops);
        EXPECT_EQ(a.surfaces[s].material, b.surfaces[s].material);
        EXPECT_EQ(a.surfaces[s].object, b.surfaces[s].object);
        EXPECT_EQ(a.surfaces[s].area, b.surfaces[s].area);
        EXPECT_EQ(a.surfaces[s].frame.origin, b.surfaces[s].frame.origin);
        EXPECT_EQ(a.surfaces[s].frame.u, b.surfaces[s].frame.u);
    }
    ASSERT_EQ(a.contact_lines.size(), b.contact_lines.size());
    for (std::size_t l = 0; l < a.contact_lines.size(); ++l) {
        EXPECT_EQ(a.contact_lines[l].surface, b.contact_lines[l].surface);
        EXPECT_EQ(a.contact_lines[l].start, b.contact_lines[l].start);
        EXPECT_EQ(a.contact_lines[l].end, b.contact_lines[l].end);
    }
}

inline double total_area(const Scene& scene, const std::string& material)
{
    double sum = 0;
    for (const Surface& surface : scene.surfaces) {
        if (scene.materials[surface.material.value].name == material) sum += surface.area;
    }
    return sum;
}

inline std::size_t count_of(const Scene& scene, const std::string& material)
{
    std::size_t count = 0;
    for (const Surface& surface : scene.surfaces) count += scene.materials[surface.material.value].name == material;
    return count;
}

/// Runs `read`, which must throw; gives "code: message".
inline std::string error_of(const std::function<void()>& read)
{
    try {
        read();
    } catch (const SceneError& error) {
        return error.code() + ": " + error.what();
    }
    return "no error";
}

}  // namespace patchlight::testing
