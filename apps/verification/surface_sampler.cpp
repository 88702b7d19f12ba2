#include "apps/verification/surface_sampler.h"

#include "formfactor/random_numbers.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace patchlight {

SurfaceSampler::SurfaceSampler(const Scene& scene, const std::function<double(SurfaceId)>& weight) : scene_(&scene)
{
    std::vector<double> weights(scene.surfaces.size());
    for (std::size_t s = 0; s < weights.size(); ++s) weights[s] = weight(SurfaceId(s));
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto& c = scene.triangles[t].vertices;
        const Vec3& a = scene.vertices[c[0]];
        const double area = glm::length(glm::cross(scene.vertices[c[1]] - a, scene.vertices[c[2]] - a)) / 2;
        for (const SurfaceId surface : {scene.triangles[t].front, scene.triangles[t].back}) {
            if (!surface.valid() || !(weights[surface.value] * area > 0)) continue;
            sides_.push_back({t, surface, total_, weights[surface.value] * area});
            total_ += sides_.back().weight;
        }
    }
    density_ = std::move(weights);
    for (double& d : density_) d = total_ > 0 ? d / total_ : 0;
}

DrawnPoint SurfaceSampler::at(double u, double v) const
{
    const double wanted = u * total_;
    const auto after = std::upper_bound(sides_.begin() + 1, sides_.end(), wanted,
                                        [](double w, const Side& s) { return w < s.before; });
    const Side& side = *(after - 1);
    const double rest = std::clamp((wanted - side.before) / side.weight, 0.0, 1.0);
    const double across = std::sqrt(rest);
    const auto& c = scene_->triangles[side.triangle].vertices;
    const Vec3 &a = scene_->vertices[c[0]], &b = scene_->vertices[c[1]], &d = scene_->vertices[c[2]];
    return {side.surface, (1 - across) * a + across * ((1 - v) * b + v * d)};
}

SurfaceSampler reflecting_surface(const Scene& scene)
{
    return {scene, [&](SurfaceId s) { return scene.material_of(s).reflects() ? 1.0 : 0.0; }};
}

std::vector<DrawnPoint> draw_points(const SurfaceSampler& surface, std::size_t count, std::uint64_t seed)
{
    if (!(surface.total() > 0)) return {};
    std::vector<DrawnPoint> points(count);
    for (std::size_t k = 0; k < count; ++k) {
        RandomNumbers random(seed, k);
        const double u = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count);
        points[k] = surface.at(u, random.uniform());
    }
    return points;
}

}  // namespace patchlight
