#include "formfactor/lambert.h"

#include "meshing/positive_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace patchlight {

namespace {

/// Contribution of the directed edge from a to b (both relative to the point).
double edge_term(const Vec3& a, const Vec3& b, const Vec3& n)
{
    const Vec3 c = glm::cross(a, b);
    const double length = glm::length(c);
    if (length == 0) return 0;
    return std::atan2(length, glm::dot(a, b)) * glm::dot(n, c) / length;
}

}  // namespace

double lambert_factor(const Vec3& p, const Vec3& n, std::span<const Vec3> polygon)
{
    const Vec3 facing = glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]);
    if (glm::dot(facing, p - polygon[0]) <= 0) return 0;

    double sum = 0;
    bool any = false;
    Vec3 first(0.0), last(0.0);
    const auto emit = [&](const Vec3& r) {
        if (any)
            sum += edge_term(last, r, n);
        else
            first = r;
        last = r;
        any = true;
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 a = polygon[i] - p, b = polygon[(i + 1) % polygon.size()] - p;
        const double da = glm::dot(n, a), db = glm::dot(n, b);
        if (da >= 0) emit(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) emit(a + (da / (da - db)) * (b - a));
    }
    if (!any) return 0;
    sum += edge_term(last, first, n);
    // Seen from the point a polygon that faces it runs clockwise.
    return positive_part(-sum / (2 * std::numbers::pi));
}

}  // namespace patchlight
