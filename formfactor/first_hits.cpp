#include "formfactor/first_hits.h"

#include "formfactor/hemisphere.h"
#include "formfactor/source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

namespace {

/// Shares of cosine-weighted rays from the front of a surface that meet backs, and nothing.
std::pair<double, double> from_surface(const Scene& scene, const RayCaster& caster, SurfaceId surface, int rays,
                                       std::uint64_t seed)
{
    const auto set = hemisphere_sets({.rays = std::max(16, rays), .seed = seed + surface.value}, 1).front();
    const Source area(scene, surface);
    const PlaneFrame& frame = scene.surface(surface).frame;
    RandomNumbers random(seed, surface.value);
    RayBatch batch;
    batch.resize(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Vec3 direction = static_cast<double>(set.x[i]) * frame.u + static_cast<double>(set.y[i]) * frame.v
            + static_cast<double>(set.z[i]) * frame.n;
        const double u = random.uniform(), v = random.uniform();
        batch.set(i, caster.leave(area.point(u, v), frame.n), direction, std::numeric_limits<float>::infinity());
    }
    HitBatch hits;
    caster.closest(batch, hits);
    const auto count = [&](std::uint32_t what) {
        return static_cast<double>(std::count(hits.surface.begin(), hits.surface.end(), what))
            / static_cast<double>(set.size());
    };
    return {count(HitBatch::black_back), count(HitBatch::escaped)};
}

}  // namespace

FirstHits sample_first_hits(const Scene& scene, const RayCaster& caster, int rays, std::uint64_t seed)
{
    double area = 0, power = 0;
    const auto power_of = [&](std::size_t s) {
        const Rgb e = scene.material_of(SurfaceId(s)).emission;
        return scene.surfaces[s].area * (e.r + e.g + e.b);
    };
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        area += scene.surfaces[s].area;
        power += power_of(s);
    }
    FirstHits result;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const double area_share = scene.surfaces[s].area / area, power_share = power > 0 ? power_of(s) / power : 0;
        const int n = static_cast<int>(std::lround(rays * std::max(area_share, power_share)));
        const auto [backs, escaped] = from_surface(scene, caster, SurfaceId(s), n, seed);
        result.backs += area_share * backs;
        result.escaped += area_share * escaped;
        result.emitted_backs += power_share * backs;
        result.emitted_escaped += power_share * escaped;
    }
    return result;
}

}  // namespace patchlight
