#include "solver/secondary_sources.h"

#include "meshing/refinement.h"
#include "solver/system.h"

#include <algorithm>
#include <numeric>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace patchlight {

namespace {

double sum(const Rgb& x)
{
    return x.r + x.g + x.b;
}

/// What each surface reflects of the emitters' light, W.
std::vector<Rgb> reflected_power(const Scene& scene, const DirectLight& direct)
{
    const PatchMesh mesh = triangulate(scene, {.min_angle = 0});
    std::vector<Rgb> power(scene.surfaces.size(), Rgb(0.0));
    tbb::enumerable_thread_specific<DirectLight::Scratch> scratches;
    tbb::parallel_for(std::size_t{0}, power.size(), [&](std::size_t s) {
        const SurfaceId surface(s);
        const Rgb rho = scene.material_of(surface).reflectance;
        if (!scene.material_of(surface).reflects()) return;
        for (const PatchId p : mesh.patches_of(surface))
            power[s] +=
                mesh.area(p) * rho * direct_irradiance(scene, direct, mesh.centroid(p), surface, scratches.local());
    });
    return power;
}

}  // namespace

std::vector<SecondarySource> secondary_sources(const Scene& scene, const DirectLight& direct, double share,
                                               std::size_t most)
{
    if (share <= 0 || most == 0) return {};
    const std::vector<Rgb> power = reflected_power(scene, direct);
    std::vector<std::size_t> order(power.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return sum(power[a]) > sum(power[b]); });
    const double all =
        std::accumulate(power.begin(), power.end(), 0.0, [](double total, const Rgb& p) { return total + sum(p); });
    std::vector<SecondarySource> sources;
    double held = 0;
    for (const std::size_t s : order) {
        if (sources.size() >= most || held >= share * all) break;
        sources.push_back({SurfaceId(s), power[s] / scene.surfaces[s].area});
        held += sum(power[s]);
    }
    return sources;
}

}  // namespace patchlight
