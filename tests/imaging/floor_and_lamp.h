#pragma once

#include "meshing/patch_mesh.h"

namespace patchlight::testing {

/// A white floor [0,1]² at z = 0 that faces up, and a lamp [¼,¾]² at z = 1 that faces down, in a frame whose centre
/// is `center`.
inline Scene floor_and_lamp()
{
    Scene scene;
    scene.name = "floor and lamp";
    scene.center = {10, 20, 30};
    scene.diameter = 1.7320508075688772;
    scene.unit = 0.5;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                      {.25, .25, 1}, {.25, .75, 1}, {.75, .75, 1}, {.75, .25, 1}};
    scene.materials = {{"white", Rgb(0.5), Rgb(0.0), false}, {"lamp", Rgb(0.0), Rgb(3, 2, 1), false}};
    scene.objects = {"floor", "lamp"};
    Surface floor, lamp;
    floor.material = MaterialId(0);
    floor.object = ObjectId(0);
    floor.frame = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    floor.area = 1;
    floor.loops = {{0, 1, 2, 3}};
    lamp.material = MaterialId(1);
    lamp.object = ObjectId(1);
    lamp.frame = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    lamp.area = 0.25;
    lamp.loops = {{4, 5, 6, 7}};
    scene.surfaces = {floor, lamp};
    scene.triangles = {{{0, 1, 2}, SurfaceId(0), {}}, {{0, 2, 3}, SurfaceId(0), {}},
                       {{4, 5, 6}, SurfaceId(1), {}}, {{4, 6, 7}, SurfaceId(1), {}}};
    return scene;
}

/// The floor in 2 n² triangles, the lamp in two.
inline PatchMesh grid_mesh(const Scene& scene, std::uint32_t n)
{
    PatchMeshArrays arrays;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            arrays.positions.push_back({double(i) / n, double(j) / n, 0});
            arrays.vertex_surface.push_back(SurfaceId(0));
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            arrays.triangles.push_back({a, a + 1, a + n + 2});
            arrays.triangles.push_back({a, a + n + 2, a + n + 1});
            arrays.patch_surface.insert(arrays.patch_surface.end(), 2, SurfaceId(0));
        }
    }
    const auto first = static_cast<std::uint32_t>(arrays.positions.size());
    for (std::size_t k = 4; k < 8; ++k) {
        arrays.positions.push_back(scene.vertices[k]);
        arrays.vertex_surface.push_back(SurfaceId(1));
    }
    arrays.triangles.push_back({first, first + 1, first + 2});
    arrays.triangles.push_back({first, first + 2, first + 3});
    arrays.patch_surface.insert(arrays.patch_surface.end(), 2, SurfaceId(1));
    return PatchMesh(scene, std::move(arrays));
}

}  // namespace patchlight::testing
