#include "solver/gather.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <tbb/enumerable_thread_specific.h>

namespace patchlight {

GatheredLight gather_irradiance(const Exchange& exchange, const Radiosity& B, std::span<const SurfacePoint> points,
                                const GatherOptions& options, const WorkMonitor& monitor)
{
    const FormFactorOptions sampling{.rays = options.rays,
                                     .shadow_rays = options.shadow_rays,
                                     .small_source = options.small_source,
                                     .seed = options.seed};
    const std::vector<SurfaceId> sources = exchange.direct ? std::vector<SurfaceId>{} : emitters(exchange.scene);
    const RowSampler sampler(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, sources, sampling);
    Radiosity arriving = B;
    if (exchange.direct)
        for (const PatchId p : exchange.mesh.patches())
            arriving[p] -= exchange.scene.material_of(exchange.mesh.surface(p)).emission;
    tbb::enumerable_thread_specific<DirectLight::Scratch> scratches;
    GatheredLight result;
    result.irradiance.assign(points.size(), Rgb(0.0));
    result.rays = for_each_row<RowScratch>(points.size(), monitor, [&](std::size_t i, RowScratch& scratch) {
        const SurfacePoint& point = points[i];
        if (!exchange.scene.material_of(point.surface).reflects()) return;
        sampler.point_row(point.position, point.surface, point.surface.value, i, scratch);
        Rgb H(0.0);
        for (std::size_t k = 0; k < scratch.row.patches.size(); ++k)
            H += scratch.row.factors[k] * arriving[scratch.row.patches[k]];
        if (exchange.direct)
            H += direct_irradiance(exchange.scene, *exchange.direct, point.limit, point.surface, scratches.local());
        result.irradiance[i] = H;
    });
    return result;
}

namespace {

/// Toward `inside` by a part of the way, but by `least` (of the diameter), but never more than a quarter of it.
Vec3 moved(const Vec3& point, const Vec3& inside, double part, double least, double diameter)
{
    const Vec3 way = inside - point;
    const double length = glm::length(way);
    if (length == 0) return point;
    return point + std::min(0.25, std::max(part, least * diameter / length)) * way;
}

}  // namespace

SurfacePoint border_point(const Vec3& place, const Vec3& inside, SurfaceId surface, double diameter)
{
    // Single precision knows a place to about 1e-7 of the diameter: at 5e-5 one ray in hundreds passes an edge so
    // near that it may be taken for a hit on the other side. Exact light tells places apart that differ by the snap,
    // 1e-8.
    return {moved(place, inside, 1e-3, 5e-5, diameter), surface, moved(place, inside, 1e-6, 5e-8, diameter)};
}

std::vector<SurfacePoint> vertex_points(const Exchange& exchange)
{
    const PatchMesh& mesh = exchange.mesh;
    std::vector<SurfacePoint> points;
    points.reserve(mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) {
        if (!mesh.on_border(v)) {
            points.push_back({mesh.position(v), mesh.surface(v), mesh.position(v)});
            continue;
        }
        Vec3 inside(0.0);
        const auto around = mesh.patches_around(v);
        for (const PatchId p : around) inside += mesh.centroid(p) / static_cast<double>(around.size());
        points.push_back(border_point(mesh.position(v), inside, mesh.surface(v), exchange.scene.diameter));
    }
    return points;
}

void share_irradiance(const Exchange& exchange, double crease_angle, std::vector<Rgb>& irradiance)
{
    const PatchMesh& mesh = exchange.mesh;
    const Scene& scene = exchange.scene;
    // Corners of the input are welded: vertices at one place have the same bits.
    std::map<std::tuple<double, double, double, std::uint32_t>, std::vector<VertexId>> places;
    for (const VertexId v : mesh.vertices()) {
        if (!mesh.on_border(v)) continue;
        const Vec3& p = mesh.position(v);
        places[{p.x, p.y, p.z, scene.surface(mesh.surface(v)).material.value}].push_back(v);
    }
    const double cosine = std::cos(crease_angle * std::numbers::pi / 180);
    for (const auto& [place, group] : places) {
        if (group.size() < 2) continue;
        std::vector<Rgb> shared;
        for (const VertexId v : group) {
            Rgb sum(0.0);
            double count = 0;
            for (const VertexId w : group)
                if ((v == w || mesh.surface(v) != mesh.surface(w)) &&
                    glm::dot(scene.surface(mesh.surface(v)).frame.n, scene.surface(mesh.surface(w)).frame.n) >=
                        cosine) {
                    sum += irradiance[w.value];
                    ++count;
                }
            shared.push_back(count > 0 ? sum / count : irradiance[v.value]);
        }
        for (std::size_t k = 0; k < group.size(); ++k) irradiance[group[k].value] = shared[k];
    }
}

VertexRadiosity linear_radiosity(const Exchange& exchange, std::span<const Rgb> irradiance)
{
    VertexRadiosity B(exchange.mesh.vertex_count());
    for (const VertexId v : exchange.mesh.vertices()) {
        const Material& material = exchange.scene.material_of(exchange.mesh.surface(v));
        B[v] = material.emission + material.reflectance * irradiance[v.value];
    }
    return B;
}

Reconstruction reconstruct(const Exchange& exchange, const Radiosity& B, const GatherOptions& options,
                           const WorkMonitor& monitor)
{
    GatheredLight gathered = gather_irradiance(exchange, B, vertex_points(exchange), options, monitor);
    share_irradiance(exchange, options.crease_angle, gathered.irradiance);
    return {linear_radiosity(exchange, gathered.irradiance), gathered.rays};
}

}  // namespace patchlight
