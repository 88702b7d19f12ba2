#pragma once

#include "meshing/vectors.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

/// Direct light of a polygonal emitter behind polygonal blockers, exactly: the emitter is cut by the shadow of
/// each blocker as seen from the point, and Lambert's formula is applied to the pieces that remain.
namespace patchlight::reference {

using Loop = std::vector<Vec3>;

/// The part of a convex loop where normal · x ≥ offset.
inline Loop clip(const Loop& loop, const Vec3& normal, double offset)
{
    Loop kept;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3& a = loop[k];
        const Vec3& b = loop[(k + 1) % loop.size()];
        const double da = glm::dot(normal, a) - offset;
        const double db = glm::dot(normal, b) - offset;
        if (da >= 0) kept.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    return kept.size() < 3 ? Loop{} : kept;
}

/// Lambert: the form factor from a small patch at p with normal n to a loop that faces it, wholly above its horizon.
inline double lambert(const Vec3& p, const Vec3& n, const Loop& loop)
{
    double sum = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 a = loop[k] - p;
        const Vec3 b = loop[(k + 1) % loop.size()] - p;
        const Vec3 c = glm::cross(a, b);
        const double length = glm::length(c);
        if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(n, c) / length;
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

/// The pieces of a convex loop that a convex blocker doesn't hide from p: outside the cone over the blocker's
/// edges, or inside it but nearer than the blocker.
inline void append_unhidden(Loop loop, const Vec3& p, const Loop& blocker, std::vector<Loop>& pieces)
{
    Vec3 towards = glm::cross(blocker[1] - blocker[0], blocker[2] - blocker[0]);
    const double distance = glm::dot(towards, p - blocker[0]);
    if (distance == 0) {
        pieces.push_back(std::move(loop));  // seen from within its own plane a blocker has no width
        return;
    }
    const double turn = distance > 0 ? 1 : -1;
    towards *= turn;
    std::vector<std::pair<Vec3, double>> inward{{-towards, -glm::dot(towards, blocker[0])}};
    for (std::size_t k = 0; k < blocker.size(); ++k) {
        const Vec3 side = turn * glm::cross(blocker[(k + 1) % blocker.size()] - p, blocker[k] - p);
        inward.emplace_back(side, glm::dot(side, p));
    }
    for (const auto& [normal, offset] : inward)
        if (clip(loop, normal, offset).empty()) {
            pieces.push_back(std::move(loop));  // beside it as a whole: else many blockers leave ever more pieces
            return;
        }
    for (const auto& [normal, offset] : inward) {
        if (Loop outside = clip(loop, -normal, -offset); !outside.empty()) pieces.push_back(std::move(outside));
        loop = clip(loop, normal, offset);
        if (loop.empty()) return;
    }
}

/// The form factor from a small patch at p with normal n to a convex light (counter-clockwise seen from its
/// front) behind convex, thin, two-sided blockers. Irradiance = factor × the light's exitance.
inline double lit_factor(const Vec3& p, const Vec3& n, const Loop& light, const std::vector<Loop>& blockers)
{
    const Vec3 front = glm::cross(light[1] - light[0], light[2] - light[0]);
    if (glm::dot(front, p - light[0]) <= 0) return 0;
    std::vector<Loop> lit;
    if (Loop above = clip(light, n, glm::dot(n, p)); !above.empty()) lit.push_back(std::move(above));
    for (const Loop& blocker : blockers) {
        std::vector<Loop> pieces;
        for (Loop& loop : lit) append_unhidden(std::move(loop), p, blocker, pieces);
        lit = std::move(pieces);
    }
    double factor = 0;
    for (const Loop& loop : lit) factor += lambert(p, n, loop);
    return factor;
}

}  // namespace patchlight::reference
