#include "formfactor/facet_points.h"
#include "formfactor/hemicube.h"
#include "formfactor/independent_groups.h"
#include "formfactor/pair_factor.h"
#include "formfactor/ray_caster.h"
#include "formfactor/scrambled_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>
#include <utility>

namespace patchlight {

namespace {

constexpr std::size_t most_groups = 16;
constexpr std::uint32_t target = 0, other = 1;

/// The scene as a hemicube takes it: fronts of `to` are the target, all other sides just block.
std::vector<HemicubeTriangle> triangles_of(const Scene& scene, std::span<const Facet> to)
{
    std::vector<std::uint32_t> items(scene.surfaces.size(), other);
    for (const Facet& facet : to) items[facet.surface.value] = target;
    std::vector<HemicubeTriangle> triangles;
    for (const SceneTriangle& t : scene.triangles) {
        const Vec3 &a = scene.vertices[t.vertices[0]], &b = scene.vertices[t.vertices[1]],
                   &c = scene.vertices[t.vertices[2]];
        // Sides of no surface are black: so one triangle does unless the back is a surface too.
        if (t.front.valid() || !t.back.valid())
            triangles.push_back({{a, b, c}, t.front.valid() ? items[t.front.value] : other});
        if (t.back.valid()) triangles.push_back({{a, c, b}, items[t.back.value]});
    }
    return triangles;
}

double seen_of_target(Hemicube& cube, HemicubeSums& sums)
{
    cube.sum(sums);
    for (std::size_t k = 0; k < sums.items.size(); ++k)
        if (sums.items[k] == target) return sums.factors[k];
    return 0;
}

}  // namespace

PairFactor pair_by_hemicube(const Scene& scene, std::span<const Facet> from, std::span<const Facet> to,
                            const PairOptions& options)
{
    const FacetPoints origins(from);
    const std::vector<HemicubeTriangle> triangles = triangles_of(scene, to);
    const auto count = static_cast<std::size_t>(std::max(1, options.origins));
    std::vector<GroupSum> groups(std::min(count, most_groups));
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        Hemicube cube(options.resolution);
        HemicubeSums sums;
        const ScrambledPoints points(options.seed, 2 * g);
        RandomNumbers random(options.seed, 2 * g + 1);
        GroupSum& group = groups[g];
        group.count = share_of_group(count, groups.size(), g);
        group.samples = group.count * cube.pixels();
        for (std::size_t k = 0; k < group.count; ++k) {
            const auto [u, v] = points(static_cast<std::uint32_t>(k));
            const FacetPoint origin = origins.at(u, v);
            PlaneFrame frame = scene.surface(from[origin.facet].surface).frame;
            frame.origin = origin.position + departure * scene.diameter * frame.n;
            cube.render(triangles, frame, 2 * std::numbers::pi * random.uniform());
            group.sum += seen_of_target(cube, sums);
        }
    });
    return combine(groups);
}

}  // namespace patchlight
