#include "formfactor/first_hits.h"

#include "formfactor/hemisphere.h"
#include "formfactor/source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

namespace {

constexpr std::size_t rays_of_a_point = 16;

/// Shares of cosine-weighted rays from the front of a surface that meet backs, and nothing. A point all of whose
/// rays meet backs is covered (the floor inside a standing solid) and not counted: it says nothing of the winding.
struct Shares {
    double backs = 0, escaped = 0;
};

Shares from_surface(const Scene& scene, const RayCaster& caster, SurfaceId surface, std::span<const Facet> facets,
                    std::size_t points, std::uint64_t seed)
{
    const auto sets = hemisphere_sets({.rays = rays_of_a_point, .seed = seed + surface.value}, 8);
    const Source area(scene, surface, facets);
    const PlaneFrame& frame = scene.surface(surface).frame;
    RandomNumbers random(seed, surface.value);
    RayBatch batch;
    HitBatch hits;
    double rays = 0, backs = 0, escaped = 0;
    for (std::size_t point = 0; point < points; ++point) {
        const HemisphereSet& set = sets[point % sets.size()];
        const double u = random.uniform(), v = random.uniform();
        const Vec3 origin = caster.leave(area.point(u, v), frame.n);
        batch.resize(set.size());
        for (std::size_t i = 0; i < set.size(); ++i)
            batch.set(i, origin,
                      static_cast<double>(set.x[i]) * frame.u + static_cast<double>(set.y[i]) * frame.v +
                          static_cast<double>(set.z[i]) * frame.n,
                      std::numeric_limits<float>::infinity());
        caster.closest(batch, hits);
        const auto met = [&](std::uint32_t what) {
            return static_cast<double>(std::count(hits.surface.begin(), hits.surface.end(), what));
        };
        const double all = static_cast<double>(set.size());
        if (met(HitBatch::black_back) == all) continue;
        rays += all;
        backs += met(HitBatch::black_back);
        escaped += met(HitBatch::escaped);
    }
    return rays > 0 ? Shares{backs / rays, escaped / rays} : Shares{};
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
    const std::vector<Facet> facets = facets_of(scene);
    FirstHits result;
    for (std::size_t s = 0, first = 0, last = 0; s < scene.surfaces.size(); ++s, first = last) {
        while (last < facets.size() && facets[last].surface == SurfaceId(s)) ++last;
        const double area_share = scene.surfaces[s].area / area, power_share = power > 0 ? power_of(s) / power : 0;
        const double share = std::max(area_share, power_share);
        const auto points = static_cast<std::size_t>(std::ceil(rays * share / static_cast<double>(rays_of_a_point)));
        const auto [backs, escaped] =
            from_surface(scene, caster, SurfaceId(s), std::span(facets).subspan(first, last - first), points, seed);
        result.backs += area_share * backs;
        result.escaped += area_share * escaped;
        result.emitted_backs += power_share * backs;
        result.emitted_escaped += power_share * escaped;
    }
    return result;
}

}  // namespace patchlight
