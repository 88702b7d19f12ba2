#include "solver/element_light.h"

#include <glm/common.hpp>

namespace patchlight {

Rgb ElementLight::at(PatchId patch, const Vec2& q) const
{
    const auto w = locator.barycentric(patch, q);
    const auto c = mesh.corners(patch);
    Rgb B(0.0);
    if (!middle_B || middle_B->empty()) {
        for (std::size_t k = 0; k < 3; ++k) B += w[k] * vertex_B[c[k]];
        return B;
    }
    const auto& middle = (*middle_B)[patch];
    for (std::size_t k = 0; k < 3; ++k)
        B += w[k] * (2 * w[k] - 1) * vertex_B[c[k]] + 4 * w[k] * w[(k + 1) % 3] * middle[k];
    return glm::max(B, Rgb(0.0));
}

Rgb ElementLight::at(SurfaceId surface, const Vec2& q) const
{
    const PatchId patch = locator.locate(surface, static_cast<float>(q.x), static_cast<float>(q.y));
    return patch.valid() ? at(patch, q) : Rgb(0.0);
}

}  // namespace patchlight
