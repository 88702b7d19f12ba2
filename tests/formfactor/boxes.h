#pragma once

#include "meshing/patch_mesh.h"
#include "meshing/refinement.h"

#include <array>
#include <vector>

/// Small scenes built in code.
namespace patchlight::testing {

/// A planar surface with the corners counter-clockwise seen from its front; its triangles are a fan.
inline void add_surface(Scene& scene, const std::vector<Vec3>& corners, std::size_t material)
{
    Surface surface;
    surface.material = MaterialId(material);
    surface.object = ObjectId(std::size_t{0});
    const Vec3 n = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const Vec3 u = glm::normalize(corners[1] - corners[0]);
    surface.frame = {corners[0], u, glm::cross(n, u), n};
    std::vector<std::uint32_t> loop;
    for (const Vec3& corner : corners) {
        loop.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
        scene.vertices.push_back(corner);
    }
    for (std::size_t k = 2; k < loop.size(); ++k) {
        surface.area += 0.5 * glm::length(glm::cross(corners[k - 1] - corners[0], corners[k] - corners[0]));
        scene.triangles.push_back({{loop[0], loop[k - 1], loop[k]}, SurfaceId(scene.surfaces.size()), {}});
    }
    surface.loops.push_back(loop);
    scene.surfaces.push_back(surface);
    scene.diameter = std::max(scene.diameter, 2 * glm::length(corners[0]));
}

/// The inside of the cube [−1, 1]³ (edge 2): floor, ceiling, and four walls, one material each by `materials`.
inline Scene cube_inside(const std::array<std::size_t, 6>& materials, std::vector<Material> list)
{
    Scene scene;
    scene.objects = {"cube"};
    scene.materials = std::move(list);
    const auto p = [](int x, int y, int z) { return Vec3(x, y, z); };
    add_surface(scene, {p(-1, -1, -1), p(1, -1, -1), p(1, 1, -1), p(-1, 1, -1)}, materials[0]);
    add_surface(scene, {p(-1, -1, 1), p(-1, 1, 1), p(1, 1, 1), p(1, -1, 1)}, materials[1]);
    add_surface(scene, {p(-1, -1, -1), p(-1, -1, 1), p(1, -1, 1), p(1, -1, -1)}, materials[2]);
    add_surface(scene, {p(-1, 1, -1), p(1, 1, -1), p(1, 1, 1), p(-1, 1, 1)}, materials[3]);
    add_surface(scene, {p(-1, -1, -1), p(-1, 1, -1), p(-1, 1, 1), p(-1, -1, 1)}, materials[4]);
    add_surface(scene, {p(1, -1, -1), p(1, -1, 1), p(1, 1, 1), p(1, 1, -1)}, materials[5]);
    scene.closed = true;
    return scene;
}

}  // namespace patchlight::testing
