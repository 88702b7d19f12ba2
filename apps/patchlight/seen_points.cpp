#include "apps/patchlight/seen_points.h"

#include "apps/imaging/view_rays.h"
#include "apps/patchlight/view_choice.h"
#include "formfactor/random_numbers.h"

#include <limits>
#include <optional>

namespace patchlight {

namespace {

constexpr int height = 120;

ViewRays camera_of(const View& view, int& width)
{
    width = picture_size(std::nullopt, view).first * height / picture_size(std::nullopt, view).second;
    return {view, width, height};
}

/// Where fronts are seen along rays from a camera, each given by its direction.
std::vector<DrawnPoint> met(const Scene& scene, const RayCaster& caster, const Vec3& from,
                            const std::vector<Vec3>& directions)
{
    RayBatch rays;
    HitBatch hits;
    rays.resize(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
        rays.set(i, from, directions[i], std::numeric_limits<float>::infinity());
    caster.closest(rays, hits);
    std::vector<DrawnPoint> points;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits.surface[i] >= HitBatch::black_back) continue;
        const SurfaceId surface(hits.surface[i]);
        points.push_back({surface, scene.surface(surface).frame.lift(Vec2(hits.x[i], hits.y[i]))});
    }
    return points;
}

}  // namespace

std::vector<SurfacePoint> seen_points(const Scene& scene, const RayCaster& caster, const View& view)
{
    int width = 0;
    const ViewRays camera = camera_of(view, width);
    std::vector<Vec3> directions;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) directions.push_back(camera.direction(x + 0.5, y + 0.5));
    std::vector<SurfacePoint> points;
    for (const DrawnPoint& p : met(scene, caster, camera.from(), directions))
        points.push_back({p.position, p.surface, p.position});
    return points;
}

std::vector<DrawnPoint> draw_seen_points(const Scene& scene, const RayCaster& caster, const View& view,
                                         std::size_t count, std::uint64_t seed)
{
    int width = 0;
    const ViewRays camera = camera_of(view, width);
    std::vector<Vec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
        RandomNumbers random(seed, i);
        const double x = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
        directions.push_back(camera.direction(x * width, random.uniform() * height));
    }
    std::vector<DrawnPoint> points = met(scene, caster, camera.from(), directions);
    std::erase_if(points, [&](const DrawnPoint& p) { return !scene.material_of(p.surface).reflects(); });
    return points;
}

}  // namespace patchlight
