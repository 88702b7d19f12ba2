#include "solver/emitted_light.h"

#include <algorithm>
#include <utility>

namespace patchlight {

namespace {

constexpr int least_shadow_rays = 16;
constexpr std::uint64_t shadow_stream = 0x5ad1ULL << 48;

struct Scratch {
    DirectLight::Scratch exact;
    ShadowScratch shadow;
    std::vector<double> unoccluded;
    std::size_t traced = 0;
};

Rgb sampled(const Exchange& exchange, std::span<const Source> sources, const SurfacePoint& point, std::uint64_t key,
            const GatherOptions& options, Scratch& scratch)
{
    const ReceiverPoint receiver{point.position, exchange.scene.surface(point.surface).frame.n};
    double all = 0;
    scratch.unoccluded.assign(sources.size(), 0.0);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        if (sources[s].surface() == point.surface) continue;
        scratch.unoccluded[s] = std::max(0.0, sources[s].unoccluded(receiver.position, receiver.normal));
        all += scratch.unoccluded[s];
    }
    RandomNumbers random(options.seed, shadow_stream ^ key);
    Rgb H(0.0);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        if (scratch.unoccluded[s] == 0) continue;
        const int rays =
            std::max(least_shadow_rays, static_cast<int>(options.shadow_rays * scratch.unoccluded[s] / all));
        H += visible_factor(exchange.caster, sources[s], {&receiver, 1}, std::min(rays, options.shadow_rays), random,
                            scratch.shadow) *
             exchange.scene.material_of(sources[s].surface()).emission;
        scratch.traced += std::exchange(scratch.shadow.traced, 0);
    }
    return H;
}

}  // namespace

GatheredLight EmittedLight::at(const Exchange& exchange, std::span<const SurfacePoint> points,
                               const GatherOptions& options, const WorkMonitor& monitor) const
{
    GatheredLight result;
    result.irradiance.assign(points.size(), Rgb(0.0));
    if (!is_apart(exchange)) return result;
    result.rays = for_each_row<Scratch>(points.size(), monitor, [&](std::size_t i, Scratch& scratch) {
        const SurfacePoint& point = points[i];
        if (!exchange.scene.material_of(point.surface).reflects()) return;
        result.irradiance[i] = exchange.direct ? direct_irradiance(exchange.scene, *exchange.direct, point.limit,
                                                                   point.surface, scratch.exact)
                                               : sampled(exchange, sources, point, i, options, scratch);
    });
    return result;
}

}  // namespace patchlight
