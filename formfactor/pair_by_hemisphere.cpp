#include "formfactor/facet_points.h"
#include "formfactor/hemisphere.h"
#include "formfactor/independent_groups.h"
#include "formfactor/pair_factor.h"
#include "formfactor/random_numbers.h"
#include "formfactor/scrambled_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {

namespace {

constexpr std::size_t most_groups = 16;
constexpr std::size_t least_rays = 8, most_rays = 65536;  // of one origin

/// Directions and origins share the rays evenly: both then leave errors of one size.
std::size_t rays_of_an_origin(std::size_t rays)
{
    std::size_t n = least_rays;
    while (n < most_rays && n * n < rays) n *= 2;
    return n;
}

/// All rays of a set from one point.
void start_all_at(const Vec3& p, RayBatch& rays)
{
    std::fill_n(rays.ox.begin(), rays.size(), static_cast<float>(p.x));
    std::fill_n(rays.oy.begin(), rays.size(), static_cast<float>(p.y));
    std::fill_n(rays.oz.begin(), rays.size(), static_cast<float>(p.z));
}

struct Hits {
    double factor = 0;
    std::size_t rays = 0;
};

/// The point factor of what `is_target` tells, by rays over the hemisphere in a random turn.
Hits trace(const RayCaster& caster, const std::vector<std::uint8_t>& is_target, const PlaneFrame& frame,
           std::size_t rays, RandomNumbers& random, RayBatch& batch, HitBatch& hits)
{
    const FormFactorOptions directions{.rays = static_cast<int>(rays), .seed = random.bits()};
    const HemisphereSet set = hemisphere_sets(directions, 1).front();
    aim(set, frame, 2 * std::numbers::pi * random.uniform(), batch);
    start_all_at(caster.leave(frame.origin, frame.n), batch);
    caster.closest(batch, hits);
    double sum = 0;
    for (std::size_t i = 0; i < set.size(); ++i)
        if (hits.surface[i] < is_target.size() && is_target[hits.surface[i]] != 0)
            sum += static_cast<double>(set.factor[i]);
    return {sum, set.size()};
}

}  // namespace

PairFactor pair_by_hemisphere(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                              std::span<const Facet> to, const PairOptions& options)
{
    const FacetPoints origins(from);
    std::vector<std::uint8_t> is_target(scene.surfaces.size(), 0);
    for (const Facet& facet : to) is_target[facet.surface.value] = 1;
    const std::size_t rays = rays_of_an_origin(options.rays);
    const std::size_t count = std::max<std::size_t>(1, options.rays / rays);
    std::vector<GroupSum> groups(std::min(count, most_groups));
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        RayBatch batch;
        HitBatch hits;
        const ScrambledPoints points(options.seed, 2 * g);
        RandomNumbers random(options.seed, 2 * g + 1);
        GroupSum& group = groups[g];
        group.count = share_of_group(count, groups.size(), g);
        for (std::size_t k = 0; k < group.count; ++k) {
            const auto [u, v] = points(static_cast<std::uint32_t>(k));
            const FacetPoint origin = origins.at(u, v);
            PlaneFrame frame = scene.surface(from[origin.facet].surface).frame;
            frame.origin = origin.position;
            const auto [factor, traced] = trace(caster, is_target, frame, rays, random, batch, hits);
            group.sum += factor;
            group.samples += traced;
        }
    });
    return combine(groups);
}

}  // namespace patchlight
