#include "solver/snapshots.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace patchlight {

namespace {

/// Patches that shoot together: all of an emitter, or a cell of a coarse grid over a surface.
struct Shooter {
    SurfaceId surface;
    std::vector<PatchId> patches;
};

std::vector<Shooter> coarse_shooters(const Scene& scene, const PatchMesh& mesh)
{
    const double cell = scene.diameter / 8;
    std::map<std::tuple<std::uint32_t, int, int>, Shooter> shooters;
    for (const PatchId p : mesh.patches()) {
        const SurfaceId surface = mesh.surface(p);
        const Vec2 q = scene.surface(surface).frame.to_plane(mesh.centroid(p)) / cell;
        const bool whole = scene.material_of(surface).emits();
        Shooter& shooter = shooters[{surface.value, whole ? 0 : static_cast<int>(std::floor(q.x)),
                                     whole ? 0 : static_cast<int>(std::floor(q.y))}];
        shooter.surface = surface;
        shooter.patches.push_back(p);
    }
    std::vector<Shooter> list;
    for (auto& [key, shooter] : shooters) list.push_back(std::move(shooter));
    return list;
}

Source source_of(const Scene& scene, const PatchMesh& mesh, const Shooter& shooter)
{
    const auto whole = mesh.patches_of(shooter.surface);
    if (whole.size() == shooter.patches.size()) return Source(scene, shooter.surface);
    std::vector<std::array<Vec3, 3>> triangles;
    for (const PatchId p : shooter.patches) {
        const auto c = mesh.corners(p);
        triangles.push_back({mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])});
    }
    return Source(shooter.surface, scene.surface(shooter.surface).frame.n, triangles);
}

}  // namespace

std::vector<VertexRadiosity> progressive_snapshots(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                                   const std::vector<int>& shots, const GatherOptions& options,
                                                   std::stop_token stop)
{
    const PatchLocator locator(mesh);
    const Exchange exchange{scene, caster, mesh, locator};
    const std::vector<Shooter> shooters = coarse_shooters(scene, mesh);

    std::vector<SurfacePoint> receivers;
    for (const PatchId p : mesh.patches()) receivers.push_back({mesh.centroid(p), mesh.surface(p), mesh.centroid(p)});
    const auto at_vertices = vertex_points(exchange);
    receivers.insert(receivers.end(), at_vertices.begin(), at_vertices.end());

    Radiosity unshot = emittance(scene, mesh);
    std::vector<Rgb> irradiance(mesh.vertex_count(), Rgb(0.0));
    std::vector<Rgb> arrived(receivers.size());
    const auto power = [&](const Shooter& shooter) {
        Rgb sum(0.0);
        for (const PatchId p : shooter.patches) sum += mesh.area(p) * unshot[p];
        return sum;
    };
    const auto total = [](const Rgb& x) { return x.r + x.g + x.b; };

    std::vector<VertexRadiosity> pictures;
    const int last = shots.empty() ? 0 : shots.back();
    for (int shot = 1; shot <= last; ++shot) {
        const Shooter& shooter = *std::max_element(shooters.begin(), shooters.end(), [&](const auto& a, const auto& b) {
            return total(power(a)) < total(power(b));
        });
        const Source source = source_of(scene, mesh, shooter);
        double area = 0;
        for (const PatchId p : shooter.patches) area += mesh.area(p);
        const Rgb light = power(shooter) / area;
        for_each_row<RowScratch>(receivers.size(), {stop, {}}, [&](std::size_t i, RowScratch& scratch) {
            arrived[i] = Rgb(0.0);
            const SurfaceId surface = receivers[i].surface;
            if (surface == shooter.surface || !scene.material_of(surface).reflects()) return;
            const ReceiverPoint receiver{receivers[i].position, scene.surface(surface).frame.n};
            RandomNumbers random(options.seed + static_cast<std::uint64_t>(shot), i);
            arrived[i] = light * visible_factor(caster, source, {&receiver, 1}, std::min(options.shadow_rays, 256),
                                                random, scratch.shadow);
        });
        for (const PatchId p : shooter.patches) unshot[p] = Rgb(0.0);
        for (const PatchId p : mesh.patches())
            unshot[p] += scene.material_of(mesh.surface(p)).reflectance * arrived[p.value];
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v) irradiance[v] += arrived[mesh.patch_count() + v];
        if (std::find(shots.begin(), shots.end(), shot) == shots.end()) continue;
        auto shared = irradiance;
        share_irradiance(exchange, options.crease_angle, shared);
        pictures.push_back(linear_radiosity(exchange, shared));
    }
    return pictures;
}

}  // namespace patchlight
