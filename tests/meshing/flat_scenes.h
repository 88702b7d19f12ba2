#pragma once

#include "meshing/plane_frame.h"
#include "meshing/read_scene.h"
#include "meshing/scene.h"
#include "tests/formfactor/boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

/// Surfaces built in code from loops in the plane, without a reader in between; and two scenes of several surfaces.
namespace patchlight::testing {

using PlaneLoop = std::vector<Vec2>;
using PlaneLoops = std::vector<PlaneLoop>;

inline double loop_area(const PlaneLoop& loop)
{
    double twice = 0;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) twice += cross2(loop[0], loop[i], loop[i + 1]);
    return 0.5 * twice;
}

/// One surface of material 0 in the given frame: the outer loop counter-clockwise, then the holes clockwise. Corners
/// at one place are one vertex, so that loops touch there.
inline Scene flat_scene(const PlaneLoops& loops, double reflectance = 0.5, const PlaneFrame& frame = {})
{
    Scene scene;
    scene.objects = {"flat"};
    scene.materials = {Material{.name = "paper", .reflectance = Rgb(reflectance)}};
    Surface surface;
    surface.material = MaterialId(std::size_t{0});
    surface.object = ObjectId(std::size_t{0});
    surface.frame = frame;
    PlaneLoop known;
    Vec2 low = loops[0][0], high = low;
    for (const PlaneLoop& loop : loops) {
        surface.area += loop_area(loop);
        std::vector<std::uint32_t> indices;
        for (const Vec2& q : loop) {
            const auto at = static_cast<std::size_t>(std::find(known.begin(), known.end(), q) - known.begin());
            if (at == known.size()) {
                known.push_back(q);
                scene.vertices.push_back(frame.lift(q));
            }
            indices.push_back(static_cast<std::uint32_t>(at));
            low = glm::min(low, q);
            high = glm::max(high, q);
        }
        surface.loops.push_back(indices);
    }
    scene.surfaces.push_back(surface);
    scene.diameter = glm::distance(low, high);
    return scene;
}

inline PlaneLoop rectangle_loop(double x0, double y0, double x1, double y1)
{
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline PlaneLoop turned(PlaneLoop loop)
{
    std::reverse(loop.begin(), loop.end());
    return loop;
}

struct NamedLoops {
    std::string name;
    PlaneLoops loops;
};

/// Polygons of all kinds whose own angles are all above 40°: nothing excuses a sharp patch.
inline std::vector<NamedLoops> blunt_polygons()
{
    const PlaneLoop square = rectangle_loop(0, 0, 1, 1);
    return {
        {"square", {square}},
        {"long rectangle", {rectangle_loop(0, 0, 7, 0.3)}},
        {"triangle", {{{0, 0}, {1, 0.1}, {0.4, 0.9}}}},
        {"L", {{{0, 0}, {2, 0}, {2, 0.5}, {0.5, 0.5}, {0.5, 2}, {0, 2}}}},
        {"comb",
         {{{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 0.3}, {3, 0.3}, {3, 2}, {2, 2}, {2, 0.3}, {1, 0.3}, {1, 2}, {0, 2}}}},
        {"arrow", {{{0, 0}, {1, -1}, {2, 0}, {1.3, -0.1}, {1.3, 2}, {0.7, 2}, {0.7, -0.1}}}},
        {"window", {square, turned(rectangle_loop(0.3, 0.3, 0.7, 0.6))}},
        {"two windows",
         {square, turned(rectangle_loop(0.1, 0.1, 0.4, 0.9)),
          turned({{0.55, 0.5}, {0.75, 0.3}, {0.9, 0.5}, {0.75, 0.7}})}},
        {"holes that touch",
         {square, turned(rectangle_loop(0.2, 0.2, 0.5, 0.5)), turned(rectangle_loop(0.5, 0.5, 0.8, 0.8))}},
        {"hole that touches a corner of the border",
         {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, turned({{1, 1}, {0.4, 0.9}, {0.3, 0.3}, {0.9, 0.4}})}},
        {"border that touches itself", {{{0, 0}, {1, 1}, {2, 0}, {2, 3}, {1, 1}, {0, 3}}}},
    };
}

/// Needs no frame of axes: a tilted one, away from the origin.
inline PlaneFrame tilted_frame()
{
    return frame_with_normal({0.3, -1.7, 2.2}, glm::normalize(Vec3(0.4, -0.5, 0.8)), {1, 0.3, 0});
}

/// A triangle with one corner of so many degrees, its long sides 1 m.
inline PlaneLoops sharp_triangle(double degrees)
{
    const double angle = degrees * std::numbers::pi / 180;
    return {{{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}}};
}

inline Scene grey_cube()
{
    return cube_inside({0, 0, 0, 0, 0, 0}, {Material{.name = "grey", .reflectance = Rgb(0.5)}});
}

inline Scene cornell_box()
{
    SceneOptions options;
    options.unit = 1e-3;
    return read_scene(std::filesystem::path(PATCHLIGHT_DATA) / "scenes/cornell-box.obj", options).scene;
}

}  // namespace patchlight::testing
