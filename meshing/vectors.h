#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace patchlight {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

/// Three bands of linear Rec. 709; the unit is that of the quantity (W/m² for radiosity, none for reflectance).
using Rgb = glm::dvec3;

/// Twice the signed area of the triangle (a, b, c) of a plane: positive when counter-clockwise.
inline double cross2(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace patchlight
