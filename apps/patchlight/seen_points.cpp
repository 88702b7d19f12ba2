#include "apps/patchlight/seen_points.h"

#include "apps/imaging/view_rays.h"
#include "apps/patchlight/view_choice.h"

#include <limits>
#include <optional>

namespace patchlight {

std::vector<SurfacePoint> seen_points(const Scene& scene, const RayCaster& caster, const View& view)
{
    constexpr int height = 120;
    const int width = picture_size(std::nullopt, view).first * height / picture_size(std::nullopt, view).second;
    const ViewRays camera(view, width, height);
    RayBatch rays;
    HitBatch hits;
    rays.resize(static_cast<std::size_t>(width) * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rays.set(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
                     camera.from(), camera.direction(x + 0.5, y + 0.5), std::numeric_limits<float>::infinity());
    caster.closest(rays, hits);
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits.surface[i] >= HitBatch::black_back) continue;
        const SurfaceId surface(hits.surface[i]);
        const Vec3 place = scene.surface(surface).frame.lift(Vec2(hits.x[i], hits.y[i]));
        points.push_back({place, surface, place});
    }
    return points;
}

}  // namespace patchlight
