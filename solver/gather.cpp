#include "solver/gather.h"

#include "formfactor/compressed_rows.h"
#include "meshing/surface_shells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <tbb/enumerable_thread_specific.h>

namespace patchlight {

namespace {

/// The rows of points, empty where nothing is reflected.
FormFactorMatrix point_rows(const RowSampler& sampler, const Scene& scene, std::span<const SurfacePoint> points,
                            const WorkMonitor& monitor)
{
    CompressedRows rows(points.size());
    const std::size_t rays = for_each_row<RowScratch>(points.size(), monitor, [&](std::size_t i, RowScratch& scratch) {
        if (!scene.material_of(points[i].surface).reflects()) return;
        sampler.point_row(points[i].position, points[i].surface, points[i].surface.value, i, scratch);
        rows.put(PatchId(i), scratch.row);
    });
    return rows.matrix(rays);
}

}  // namespace

GatheredLight gather_irradiance(const Exchange& exchange, const Radiosity& B, std::span<const SurfacePoint> points,
                                const GatherOptions& options, const WorkMonitor& monitor, FormFactorMatrix* kept)
{
    const FormFactorOptions sampling{.rays = options.rays,
                                     .shadow_rays = options.shadow_rays,
                                     .small_source = options.small_source,
                                     .seed = options.seed};
    const std::vector<SurfaceId> sources = exchange.direct ? std::vector<SurfaceId>{} : emitters(exchange.scene);
    const RowSampler sampler(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, sources, sampling);
    if (kept && kept->size() != points.size()) *kept = point_rows(sampler, exchange.scene, points, monitor);
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
        Rgb H(0.0);
        if (kept) {
            for (std::size_t k = kept->row_start[i]; k < kept->row_start[i + 1]; ++k)
                H += kept->factors[k] * arriving[PatchId(kept->columns[k])];
        } else {
            sampler.point_row(point.position, point.surface, point.surface.value, i, scratch);
            for (std::size_t k = 0; k < scratch.row.patches.size(); ++k)
                H += scratch.row.factors[k] * arriving[scratch.row.patches[k]];
        }
        if (exchange.direct)
            H += direct_irradiance(exchange.scene, *exchange.direct, point.limit, point.surface, scratches.local());
        result.irradiance[i] = H;
    });
    if (kept) result.rays = kept->rays;
    return result;
}

LightAtPoints light_from_patches(const Exchange& exchange, const Radiosity& B, const GatherOptions& options,
                                 FormFactorMatrix* kept)
{
    return [&exchange, &B, options, kept](std::span<const SurfacePoint> points, const WorkMonitor& monitor) {
        return gather_irradiance(exchange, B, points, options, monitor, kept);
    };
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

Vec3 middle_of_edge(const PatchMesh& mesh, PatchId patch, std::size_t k)
{
    const auto c = mesh.corners(patch);
    return 0.5 * (mesh.position(c[k]) + mesh.position(c[(k + 1) % 3]));
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

ElementPoints element_points(const Exchange& exchange)
{
    const PatchMesh& mesh = exchange.mesh;
    ElementPoints result{vertex_points(exchange), {}};
    result.midpoint_of.resize(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const auto across = mesh.neighbours(p);
        for (std::size_t k = 0; k < 3; ++k) {
            if (across[k].valid() && across[k] < p) {
                const auto back = mesh.neighbours(across[k]);
                const auto at = static_cast<std::size_t>(std::find(back.begin(), back.end(), p) - back.begin());
                result.midpoint_of[p.value][k] = result.midpoint_of[across[k].value][at];
                continue;
            }
            const Vec3 middle = middle_of_edge(mesh, p, k);
            result.midpoint_of[p.value][k] = static_cast<std::uint32_t>(result.points.size());
            result.points.push_back(
                across[k].valid() ? SurfacePoint{middle, mesh.surface(p), middle}
                                  : border_point(middle, mesh.centroid(p), mesh.surface(p), exchange.scene.diameter));
        }
    }
    return result;
}

namespace {

/// A node on its surface's border, and its entry among the irradiances.
struct BorderNode {
    Vec3 place{0.0};
    SurfaceId surface;
    std::uint32_t index = 0;
};

std::vector<BorderNode> border_vertices(const PatchMesh& mesh)
{
    std::vector<BorderNode> nodes;
    for (const VertexId v : mesh.vertices())
        if (mesh.on_border(v)) nodes.push_back({mesh.position(v), mesh.surface(v), v.value});
    return nodes;
}

std::vector<BorderNode> border_middles(const PatchMesh& mesh, const ElementPoints& points)
{
    std::vector<BorderNode> nodes;
    for (const PatchId p : mesh.patches()) {
        const auto across = mesh.neighbours(p);
        for (std::size_t k = 0; k < 3; ++k)
            if (!across[k].valid())
                nodes.push_back({middle_of_edge(mesh, p, k), mesh.surface(p), points.midpoint_of[p.value][k]});
    }
    return nodes;
}

void share(const Scene& scene, double crease_angle, std::span<const BorderNode> nodes, std::vector<Rgb>& irradiance)
{
    // Corners of the input are welded: nodes at one place have the same bits.
    std::map<std::tuple<double, double, double, std::uint32_t>, std::vector<BorderNode>> places;
    for (const BorderNode& node : nodes) {
        const Vec3& p = node.place;
        places[{p.x, p.y, p.z, scene.surface(node.surface).material.value}].push_back(node);
    }
    const double cosine = std::cos(crease_angle * std::numbers::pi / 180);
    std::vector<std::uint32_t> shells;  // found when first asked for: most scenes have no curved objects
    const auto share_a_room = [&](SurfaceId a, SurfaceId b) {
        if (shells.empty()) shells = surface_shells(scene);
        return shells[a.value] == shells[b.value];
    };
    for (const auto& [place, group] : places) {
        if (group.size() < 2) continue;
        std::vector<Rgb> shared;
        for (const BorderNode& v : group) {
            Rgb sum(0.0);
            double count = 0;
            for (const BorderNode& w : group)
                if (v.index == w.index ||
                    (v.surface != w.surface &&
                     glm::dot(scene.surface(v.surface).frame.n, scene.surface(w.surface).frame.n) >= cosine &&
                     share_a_room(v.surface, w.surface))) {
                    sum += irradiance[w.index];
                    ++count;
                }
            shared.push_back(count > 0 ? sum / count : irradiance[v.index]);
        }
        for (std::size_t k = 0; k < group.size(); ++k) irradiance[group[k].index] = shared[k];
    }
}

}  // namespace

void share_irradiance(const Exchange& exchange, double crease_angle, std::vector<Rgb>& irradiance)
{
    share(exchange.scene, crease_angle, border_vertices(exchange.mesh), irradiance);
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

Radiosity patch_means(const PatchMesh& mesh, const VertexRadiosity& B)
{
    Radiosity mean(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const auto c = mesh.corners(p);
        mean[p] = (B[c[0]] + B[c[1]] + B[c[2]]) / 3.0;
    }
    return mean;
}

Reconstruction reconstruct(const Exchange& exchange, const LightAtPoints& light, double crease_angle,
                           const WorkMonitor& monitor, Elements elements)
{
    const bool quadratic = elements == Elements::quadratic;
    const ElementPoints nodes = quadratic ? element_points(exchange) : ElementPoints{vertex_points(exchange), {}};
    GatheredLight gathered = light(nodes.points, monitor);
    share_irradiance(exchange, crease_angle, gathered.irradiance);
    Reconstruction result{linear_radiosity(exchange, gathered.irradiance), {}, gathered.rays};
    if (!quadratic) return result;
    const PatchMesh& mesh = exchange.mesh;
    share(exchange.scene, crease_angle, border_middles(mesh, nodes), gathered.irradiance);
    result.middle_B = MidpointRadiosity(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const Material& material = exchange.scene.material_of(mesh.surface(p));
        for (std::size_t k = 0; k < 3; ++k)
            result.middle_B[p][k] =
                material.emission + material.reflectance * gathered.irradiance[nodes.midpoint_of[p.value][k]];
    }
    return result;
}

}  // namespace patchlight
