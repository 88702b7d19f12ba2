#pragma once

#include "apps/verification/surface_sampler.h"
#include "formfactor/ray_caster.h"
#include "solver/gather.h"

#include <vector>

namespace patchlight {

/// What a camera sees, through the pixels of a small picture of it.
std::vector<SurfacePoint> seen_points(const Scene& scene, const RayCaster& caster, const View& view);

/// Points that a camera sees, uniform over its picture: one in each of `count` upright strips, as far as something that
/// reflects is seen there.
std::vector<DrawnPoint> draw_seen_points(const Scene& scene, const RayCaster& caster, const View& view,
                                         std::size_t count, std::uint64_t seed);

}  // namespace patchlight
