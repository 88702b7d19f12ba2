#include "apps/imaging/seen_point.h"

#include <cmath>

namespace patchlight {

std::optional<SeenPoint> seen_point(const ShownSolution& solution, const ViewRays& rays, const Vec3& direction,
                                    std::uint32_t surface)
{
    if (surface >= HitBatch::black_back) {
        return std::nullopt;
    }
    const SurfaceId id{surface};
    const PlaneFrame& frame = solution.scene.surface(id).frame;
    const double t = glm::dot(frame.origin - rays.from(), frame.n) / glm::dot(direction, frame.n);
    if (!std::isfinite(t)) {
        return std::nullopt;
    }
    const Vec2 q = frame.to_plane(rays.from() + t * direction);
    const PatchId patch = solution.locator.locate(id, static_cast<float>(q.x), static_cast<float>(q.y));
    if (!patch.valid()) {
        return std::nullopt;
    }
    return SeenPoint{id, patch, q};
}

}  // namespace patchlight
