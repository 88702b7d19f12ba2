#include "formfactor/point_factor.h"

namespace patchlight {

double point_factor(const Blockers& blockers, const Vec3& x, const Vec3& n, std::span<const Facet> to,
                    PointScratch& scratch)
{
    const std::span<const Vec3> point(&x, 1);
    Polygon front;
    double sum = 0;
    for (const Facet& facet : to) {
        if (blockers.between(point, n, facet.corners, facet.normal, scratch.between) == Visibility::hidden) continue;
        keep_front(facet.corners, n, glm::dot(n, x), blockers.snap(), front);
        scratch.views.clear();
        for (const Blocker& blocker : scratch.between) scratch.views.push_back(blocker.view());
        sum += visible_factor(x, n, front, scratch.views, scratch.visible);
    }
    return sum;
}

}  // namespace patchlight
