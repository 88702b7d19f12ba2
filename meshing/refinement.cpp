#include "meshing/refinement.h"

#include "meshing/surface_triangulation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace patchlight {

namespace {

/// Surfaces in parallel, the largest first so that both cores end together.
template <class Work>
void for_each_surface(const Scene& scene, const Work& work)
{
    std::vector<std::uint32_t> order(scene.surfaces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return scene.surfaces[a].area > scene.surfaces[b].area; });
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) { work(SurfaceId(order[i])); });
}

PatchMesh join(const Scene& scene, const std::vector<SurfaceTriangulation>& pieces)
{
    PatchMeshArrays arrays;
    for (std::size_t s = 0; s < pieces.size(); ++s) {
        const auto first = static_cast<std::uint32_t>(arrays.positions.size());
        arrays.positions.insert(arrays.positions.end(), pieces[s].positions.begin(), pieces[s].positions.end());
        for (const auto& t : pieces[s].triangles)
            arrays.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        arrays.vertex_surface.resize(arrays.positions.size(), SurfaceId(s));
        arrays.patch_surface.resize(arrays.triangles.size(), SurfaceId(s));
    }
    return PatchMesh(scene, std::move(arrays));
}

/// An angle bound costs a narrow strip as many triangles as it is longer than wide: those narrower than a
/// sixtieth of the longest edge do without.
double angle_bound(const Scene& scene, const Surface& surface, double max_edge, double min_angle)
{
    double border = 0;
    for (const auto& loop : surface.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            border += glm::distance(scene.vertices[loop[i]], scene.vertices[loop[(i + 1) % loop.size()]]);
    return 2 * surface.area / border < std::min(max_edge, border / 2) / 60 ? 0 : min_angle;
}

std::vector<SurfaceTriangulation> triangulate_all(const Scene& scene, double max_edge, double min_angle)
{
    std::vector<SurfaceTriangulation> pieces(scene.surfaces.size());
    for_each_surface(scene, [&](SurfaceId s) {
        pieces[s.value] = triangulate_polygon(scene, s);
        // Light is only followed on surfaces that reflect: others keep the fewest patches.
        if (!scene.material_of(s).reflects()) return;
        const Surface& surface = scene.surface(s);
        pieces[s.value] = refine_triangulation(
            {surface.frame, scene.diameter}, pieces[s.value], [&](const Vec2&) { return max_edge; },
            angle_bound(scene, surface, max_edge, min_angle));
    });
    return pieces;
}

std::size_t count(const std::vector<SurfaceTriangulation>& pieces)
{
    return std::accumulate(pieces.begin(), pieces.end(), std::size_t{0},
                           [](std::size_t n, const SurfaceTriangulation& p) { return n + p.triangles.size(); });
}

/// The uniform mesh with between 0.8 N and N triangles, or the nearest below N that was met.
std::vector<SurfaceTriangulation> triangulate_to_count(const Scene& scene, std::size_t wanted, double min_angle)
{
    double area = 0;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).reflects()) area += scene.surfaces[s].area;
    const double n = static_cast<double>(wanted);
    // A mesh with longest edge h has triangles of about h²/4.
    double h = std::max(2 * std::sqrt(area / n), 1e-6 * scene.diameter);
    double too_fine = 0, coarse_enough = std::numeric_limits<double>::infinity();
    std::vector<SurfaceTriangulation> best;
    std::size_t best_count = 0;
    for (int attempt = 0; attempt < 14; ++attempt) {
        auto pieces = triangulate_all(scene, h, min_angle);
        const std::size_t found = count(pieces);
        if (best.empty() ||
            (found <= wanted ? best_count > wanted || found > best_count : best_count > wanted && found < best_count)) {
            best = std::move(pieces);
            best_count = found;
        }
        if (found > wanted)
            too_fine = h;
        else
            coarse_enough = h;
        if ((found <= wanted && 10 * found >= 8 * wanted) || h > 2 * scene.diameter) break;
        const double step = std::clamp(std::sqrt(static_cast<double>(found) / (0.92 * n)), 0.5, 2.0);
        const double next = h * step;
        h = next > too_fine && next < coarse_enough ? next
            : std::isinf(coarse_enough)             ? 2 * too_fine
                                                    : 0.5 * (too_fine + coarse_enough);
    }
    return best;
}

}  // namespace

PatchMesh triangulate(const Scene& scene, const MeshingOptions& options)
{
    if (options.max_elements > 0 && options.max_edge <= 0)
        return join(scene, triangulate_to_count(scene, options.max_elements, options.min_angle));
    const double max_edge = options.max_edge > 0 ? options.max_edge : scene.diameter / 12;
    return join(scene, triangulate_all(scene, max_edge, options.min_angle));
}

Refinement refine(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const MeshingOptions& options)
{
    const PatchLocator locator(mesh);
    std::vector<SurfaceTriangulation> pieces(scene.surfaces.size());
    std::size_t honoured = plan.splits.size();
    for (;;) {
        std::vector<double> target(mesh.patch_count(), std::numeric_limits<double>::infinity());
        std::vector<std::uint8_t> touched(scene.surfaces.size(), 0);
        std::vector<double> shortest(scene.surfaces.size(), std::numeric_limits<double>::infinity());
        for (std::size_t i = 0; i < honoured; ++i) {
            const auto& split = plan.splits[i];
            target[split.patch.value] = std::min(target[split.patch.value], split.target_edge);
            const std::uint32_t surface = mesh.surface(split.patch).value;
            touched[surface] = 1;
            shortest[surface] = std::min(shortest[surface], split.target_edge);
        }
        for_each_surface(scene, [&](SurfaceId s) {
            pieces[s.value] = triangulation_of(mesh, s);
            if (touched[s.value] == 0) return;
            const TargetEdge target_at = [&](const Vec2& q) {
                return target[locator.locate(s, static_cast<float>(q.x), static_cast<float>(q.y)).value];
            };
            const Surface& surface = scene.surface(s);
            pieces[s.value] = refine_triangulation({surface.frame, scene.diameter}, pieces[s.value], target_at,
                                                   angle_bound(scene, surface, shortest[s.value], options.min_angle));
        });
        const std::size_t found = count(pieces);
        if (options.max_elements == 0 || found <= options.max_elements || honoured == 0) break;
        const double room = static_cast<double>(options.max_elements) - static_cast<double>(mesh.patch_count());
        const double growth = static_cast<double>(found - mesh.patch_count());
        const double share = std::clamp(room / growth, 0.0, 1.0);
        honoured = std::min(honoured - 1, static_cast<std::size_t>(share * static_cast<double>(honoured)));
    }
    PatchMesh refined = join(scene, pieces);
    PatchTransfer transfer = overlap(mesh, locator, refined);
    return {std::move(refined), std::move(transfer)};
}

PatchField<Rgb> prolong(const PatchMesh& new_mesh, const PatchField<Rgb>& values, const PatchTransfer& transfer)
{
    PatchField<Rgb> result(new_mesh.patch_count(), Rgb(0.0));
    for (const PatchId p : new_mesh.patches()) {
        Rgb sum(0.0);
        for (std::uint32_t i = transfer.start[p.value]; i < transfer.start[p.value + 1]; ++i)
            sum += transfer.overlaps[i].area * values[transfer.overlaps[i].old_patch];
        result[p] = sum / new_mesh.area(p);
    }
    return result;
}

}  // namespace patchlight
