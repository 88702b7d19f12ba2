#include "formfactor/convex_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace patchlight {

Vec3 area_vector(std::span<const Vec3> polygon)
{
    Vec3 twice(0.0);
    for (std::size_t k = 2; k < polygon.size(); ++k)
        twice += glm::cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    return 0.5 * twice;
}

bool precedes(const Vec3& p, const Vec3& q)
{
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

bool precedes(std::span<const Vec3> a, std::span<const Vec3> b)
{
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](const Vec3& p, const Vec3& q) { return precedes(p, q); });
}

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

Vec3 longest_extent(std::span<const Vec3> polygon)
{
    Vec3 longest(0.0);
    for (const Vec3& p : polygon)
        for (const Vec3& q : polygon)
            if (glm::dot(q - p, q - p) > glm::dot(longest, longest)) longest = q - p;
    return longest;
}

void keep_half(std::span<const Vec3> polygon, const Vec3& axis, Polygon& kept)
{
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec3& p : polygon) {
        least = std::min(least, glm::dot(axis, p));
        most = std::max(most, glm::dot(axis, p));
    }
    keep_front(polygon, axis, 0.5 * (least + most), 0, kept);
}

double squared_distance_to_rim(const Vec3& p, std::span<const Vec3> polygon)
{
    double nearest = std::numeric_limits<double>::infinity();
    Vec3 last = polygon.back();
    for (const Vec3& corner : polygon) {
        const Vec3 along = corner - last, off = p - last;
        const double square = glm::dot(along, along);
        const double t = square > 0 ? std::clamp(glm::dot(off, along) / square, 0.0, 1.0) : 0.0;
        const Vec3 gap = off - t * along;
        nearest = std::min(nearest, glm::dot(gap, gap));
        last = corner;
    }
    return nearest;
}

}  // namespace patchlight
