#pragma once

#include "apps/imaging/picture.h"
#include "apps/imaging/view_rays.h"

#include <optional>

namespace patchlight {

/// The point of a surface that a sample of a view shows.
struct SeenPoint {
    SurfaceId surface;
    PatchId patch;
    Vec2 in_plane;  ///< in the surface's frame
};

/// Where a ray that hit `surface` (a value as in HitBatch) meets that surface's plane, in double. Nothing for backs,
/// the background, and where no patch lies.
std::optional<SeenPoint> seen_point(const ShownSolution& solution, const ViewRays& rays, const Vec3& direction,
                                    std::uint32_t surface);

}  // namespace patchlight
