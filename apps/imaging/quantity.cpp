#include "apps/imaging/quantity.h"

#include "apps/imaging/seen_point.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace patchlight {

namespace {

/// H = (B − E)/ρ, weighed; NaN where a band isn't reflected.
double irradiance(const Rgb& B, const Material& material)
{
    if (glm::any(glm::lessThanEqual(material.reflectance, Rgb(0.0)))) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return luminance(glm::max(B - material.emission, Rgb(0.0)) / material.reflectance);
}

double value_at(const ShownSolution& solution, const PatchField<double>& eta, const SeenPoint& seen, Quantity quantity,
                Shade shade)
{
    const double area = solution.mesh.area(seen.patch);
    if (quantity == Quantity::size) return area;
    if (quantity == Quantity::error) return eta[seen.patch] / std::sqrt(area);
    const Rgb B = shade == Shade::flat ? solution.B[seen.patch] : solution.light().at(seen.patch, seen.in_plane);
    if (quantity == Quantity::radiosity) return luminance(B);
    const double H = irradiance(B, solution.scene.material_of(seen.surface));
    return quantity == Quantity::lux ? lumens_per_watt * H : H;
}

}  // namespace

std::string title_of(Quantity quantity)
{
    switch (quantity) {
    case Quantity::lux:
        return "illuminance, lx (683 lm/W)";
    case Quantity::irradiance:
        return "irradiance, W/m²";
    case Quantity::radiosity:
        return "radiosity, W/m²";
    case Quantity::error:
        return "estimated error of radiosity, W/m²";
    case Quantity::size:
        return "area of elements, m²";
    }
    return {};
}

QuantityMap quantity_map(const ShownSolution& solution, const PatchField<double>& eta, const ViewHits& hits,
                         Quantity quantity, Shade shade)
{
    const int across = hits.width * hits.samples, rows = hits.height * hits.samples;
    QuantityMap map{hits.samples, ScalarImage(across, rows, nothing_shown), hits.surface, {}};
    map.patch.resize(map.values.values.size(), Id<PatchTag>::invalid_value);
    const ViewRays rays(hits.view, hits.width, hits.height);
    tbb::parallel_for(tbb::blocked_range<int>(0, rows, 8), [&](const tbb::blocked_range<int>& range) {
        for (int y = range.begin(); y < range.end(); ++y) {
            for (int x = 0; x < across; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + x;
                const Vec3 d = rays.direction((x + 0.5) / hits.samples, (y + 0.5) / hits.samples);
                if (const auto seen = seen_point(solution, rays, d, hits.surface[i])) {
                    map.patch[i] = seen->patch.value;
                    map.values.values[i] = static_cast<float>(value_at(solution, eta, *seen, quantity, shade));
                }
            }
        }
    });
    return map;
}

std::vector<float> values_for_scale(const Scene& scene, const QuantityMap& map)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < map.surface.size(); ++i) {
        const std::uint32_t surface = map.surface[i];
        if (surface < HitBatch::black_back && !scene.material_of(SurfaceId(surface)).emits()) {
            values.push_back(map.values.values[i]);
        }
    }
    return values;
}

}  // namespace patchlight
