#pragma once

#include "formfactor/ray_caster.h"
#include "solver/gather.h"

#include <vector>

namespace patchlight {

/// What a camera sees, through the pixels of a small picture of it.
std::vector<SurfacePoint> seen_points(const Scene& scene, const RayCaster& caster, const View& view);

}  // namespace patchlight
