#include "meshing/surface_shells.h"

#include "meshing/space_regions.h"

#include <map>
#include <tuple>

namespace patchlight {

std::vector<std::uint32_t> surface_shells(const Scene& scene)
{
    std::map<std::tuple<double, double, double>, std::uint32_t> first_at;
    std::vector<std::uint32_t> welded;
    for (std::uint32_t v = 0; v < scene.vertices.size(); ++v) {
        const Vec3& p = scene.vertices[v];
        welded.push_back(first_at.try_emplace({p.x, p.y, p.z}, v).first->second);
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const SceneTriangle& t : scene.triangles)
        triangles.push_back({welded[t.vertices[0]], welded[t.vertices[1]], welded[t.vertices[2]]});
    SpaceRegions regions(scene.vertices, std::move(triangles), scene.diameter);
    std::vector<std::uint32_t> shells(scene.surfaces.size(), 0);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (const SurfaceId front = scene.triangles[t].front; front.valid())
            shells[front.value] = regions.shell(t, true);
        if (const SurfaceId back = scene.triangles[t].back; back.valid()) shells[back.value] = regions.shell(t, false);
    }
    return shells;
}

}  // namespace patchlight
