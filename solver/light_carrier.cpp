#include "solver/light_carrier.h"

#include "meshing/refinement.h"
#include "solver/element_light.h"

#include <tbb/parallel_for.h>

namespace patchlight {

LightCarrier::LightCarrier(const Exchange& start, const EmittedLight& emitted, const IndirectLight& indirect,
                           const CarrierOptions& options, const WorkMonitor& monitor)
    : scene_(start.scene), apart_(emitted.is_apart(start))
{
    PatchMesh mesh(scene_, start.mesh.arrays());
    const LightAtPoints light = [&](std::span<const SurfacePoint> points, const WorkMonitor& m) {
        GatheredLight found = emitted.at(start, points, options.gather, m);
        for (std::size_t i = 0; i < points.size(); ++i) found.irradiance[i] += indirect.at(scene_, points[i]);
        return found;
    };
    const MeshingOptions budget{.max_elements = std::max(mesh.patch_count(), options.max_elements)};
    for (int cycle = 0; cycle < 40; ++cycle) {
        const PatchLocator locator(mesh);
        const Exchange exchange{scene_, start.caster, mesh, locator, start.direct};
        const Evaluation found =
            evaluate(exchange, light, Indicator::residual, options.gather.crease_angle, 0, monitor);
        const RefinementPlan plan = mark(scene_, mesh, patch_means(mesh, found.vertex_B), found.error, options.mark);
        const bool full = 20 * mesh.patch_count() >= 19 * budget.max_elements;
        if (plan.empty() || full || found.error.relative < options.target_error) break;
        mesh = refined(scene_, mesh, plan, budget);
    }
    hold(start, std::move(mesh));
    direct_ = emitted.at(*exchange_, nodes_.points, options.gather, monitor).irradiance;
}

void LightCarrier::hold(const Exchange& start, PatchMesh mesh)
{
    mesh_ = std::make_unique<const PatchMesh>(std::move(mesh));
    locator_ = std::make_unique<const PatchLocator>(*mesh_);
    exchange_.emplace(Exchange{scene_, start.caster, *mesh_, *locator_, start.direct});
    nodes_ = element_points(*exchange_);
}

QuadraticRadiosity LightCarrier::leaving(const IndirectLight& indirect) const
{
    std::vector<Rgb> B(nodes_.points.size());
    tbb::parallel_for(std::size_t{0}, B.size(), [&](std::size_t i) {
        const SurfacePoint& point = nodes_.points[i];
        const Material& material = scene_.material_of(point.surface);
        B[i] = material.reflectance * (direct_[i] + indirect.at(scene_, point));
        if (!apart_) B[i] += material.emission;
    });
    QuadraticRadiosity result{VertexRadiosity(mesh_->vertex_count()), MidpointRadiosity(mesh_->patch_count())};
    for (const VertexId v : mesh_->vertices()) result.at_vertices[v] = B[v.value];
    for (const PatchId p : mesh_->patches())
        for (std::size_t k = 0; k < 3; ++k) result.at_middles[p][k] = B[nodes_.midpoint_of[p.value][k]];
    return result;
}

Rgb LightCarrier::reflected(SurfaceId surface, const Vec3& place, const QuadraticRadiosity& leaving) const
{
    const Rgb B = ElementLight{*mesh_, *locator_, leaving.at_vertices, &leaving.at_middles}.at(
        surface, scene_.surface(surface).frame.to_plane(place));
    return apart_ ? B : B - scene_.material_of(surface).emission;
}

double LightCarrier::norm(const QuadraticRadiosity& leaving) const
{
    VertexRadiosity B = leaving.at_vertices;
    if (apart_)
        for (const VertexId v : mesh_->vertices()) B[v] += scene_.material_of(mesh_->surface(v)).emission;
    return reflected_norm(scene_, *mesh_, B);
}

}  // namespace patchlight
