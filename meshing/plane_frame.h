#pragma once

#include "meshing/scene.h"

namespace patchlight {

/// The normal with components that are only rounding errors removed: within 1e-12 of an axis it is the axis.
Vec3 cleaned_normal(const Vec3& normal);

/// The frame with this origin and front; u along `direction` (which needs only roughly lie in the plane), except
/// that an axis for a normal gives axes for u and v.
PlaneFrame frame_with_normal(const Vec3& origin, const Vec3& normal, const Vec3& direction);

/// The same plane seen from its back.
PlaneFrame turned_over(const PlaneFrame& frame);

}  // namespace patchlight
