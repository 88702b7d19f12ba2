#include "apps/study/shown_points.h"

#include "solver/element_light.h"

#include <cmath>

namespace patchlight {

std::vector<ShownPoint> shown_at(const StoredSolution& stored, const std::vector<DrawnPoint>& points)
{
    const PatchLocator locator(stored.mesh);
    const ElementLight light{stored.mesh, locator, stored.vertex_B, &stored.middle_B};
    std::vector<ShownPoint> shown(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfaceId surface = points[i].surface;
        const Vec2 q = stored.scene.surface(surface).frame.to_plane(points[i].position);
        const PatchId patch = locator.locate(surface, static_cast<float>(q.x), static_cast<float>(q.y));
        if (!patch.valid()) continue;
        shown[i] = {light.at(patch, q) - stored.scene.material_of(surface).emission,
                    stored.eta[patch] / std::sqrt(stored.mesh.area(patch))};
    }
    return shown;
}

}  // namespace patchlight
