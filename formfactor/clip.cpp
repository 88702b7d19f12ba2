#include "formfactor/clip.h"

#include <cmath>

namespace patchlight {

void keep_front(std::span<const Vec3> polygon, const Vec3& n, double offset, double snap, Polygon& kept)
{
    const auto height = [&](const Vec3& p) {
        const double h = glm::dot(n, p) - offset;
        return std::abs(h) <= snap ? 0.0 : h;
    };
    kept.clear();
    bool any = false;
    Vec3 last = polygon.back();
    double last_height = height(last);
    for (const Vec3& p : polygon) {
        const double h = height(p);
        if ((h > 0 && last_height < 0) || (h < 0 && last_height > 0))
            kept.push_back(last + (last_height / (last_height - h)) * (p - last));
        if (h >= 0) kept.push_back(p);
        any = any || h > 0;
        last = p;
        last_height = h;
    }
    if (!any) kept.clear();
}

}  // namespace patchlight
