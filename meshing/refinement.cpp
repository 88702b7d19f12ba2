#include "meshing/refinement.h"

#include "meshing/surface_triangulation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

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
        const CutTriangulation piece = cut_contacts(scene.surfaces[s].frame, pieces[s]);
        arrays.positions.insert(arrays.positions.end(), piece.positions.begin(), piece.positions.end());
        for (const auto& t : piece.triangles) arrays.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        for (const MeshLine& line : piece.lines)
            arrays.lines.push_back({line.kind,
                                    {first + line.left[0], first + line.left[1]},
                                    {first + line.right[0], first + line.right[1]},
                                    line.beyond});
        arrays.vertex_surface.resize(arrays.positions.size(), SurfaceId(s));
        arrays.patch_surface.resize(arrays.triangles.size(), SurfaceId(s));
    }
    return PatchMesh(scene, std::move(arrays));
}

using LinesOfSurface = std::vector<std::vector<SurfaceLine>>;

LinesOfSurface by_surface(const Scene& scene, std::span<const SurfaceLine> lines)
{
    LinesOfSurface result(scene.surfaces.size());
    for (const SurfaceLine& line : lines) result[line.surface.value].push_back(line);
    return result;
}

double border_length(const Scene& scene, const Surface& surface)
{
    double length = 0;
    for (const auto& loop : surface.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            length += glm::distance(scene.vertices[loop[i]], scene.vertices[loop[(i + 1) % loop.size()]]);
    return length;
}

/// An angle bound costs a narrow strip as many triangles as it is longer than wide: those narrower than a
/// sixtieth of the longest edge do without.
double angle_bound(const Scene& scene, const Surface& surface, double max_edge, double min_angle)
{
    const double border = border_length(scene, surface);
    return 2 * surface.area / border < std::min(max_edge, border / 2) / 60 ? 0 : min_angle;
}

std::vector<SurfaceTriangulation> triangulate_all(const Scene& scene, double max_edge, double min_angle,
                                                  const LinesOfSurface& lines)
{
    std::vector<SurfaceTriangulation> pieces(scene.surfaces.size());
    for_each_surface(scene, [&](SurfaceId s) {
        pieces[s.value] = triangulate_polygon(scene, s);
        // Light is only followed on surfaces that reflect: others keep the fewest patches.
        if (!scene.material_of(s).reflects()) return;
        const Surface& surface = scene.surface(s);
        const MeshingPlane plane{surface.frame, scene.diameter};
        const bool has_lines = !lines[s.value].empty();
        if (has_lines) pieces[s.value] = insert_lines(plane, pieces[s.value], lines[s.value]);
        pieces[s.value] = refine_triangulation(
            plane, pieces[s.value], [&](const Vec2&) { return max_edge; },
            has_lines ? 0 : angle_bound(scene, surface, max_edge, min_angle));
    });
    return pieces;
}

std::size_t count(const std::vector<SurfaceTriangulation>& pieces)
{
    return std::accumulate(pieces.begin(), pieces.end(), std::size_t{0},
                           [](std::size_t n, const SurfaceTriangulation& p) { return n + p.triangles.size(); });
}

/// The uniform mesh with between 0.8 N and N triangles, or the nearest below N that was met.
std::vector<SurfaceTriangulation> triangulate_to_count(const Scene& scene, std::size_t wanted, double min_angle,
                                                       const LinesOfSurface& lines)
{
    double area = 0, border = 0;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        if (!scene.material_of(SurfaceId(s)).reflects()) continue;
        area += scene.surfaces[s].area;
        border += border_length(scene, scene.surfaces[s]);
    }
    const double n = static_cast<double>(wanted);
    // A mesh with longest edge h has triangles of about h²/4, and, however narrow its surfaces, with k edges on the
    // border of a surface k − 2 at least.
    double h = std::max({2 * std::sqrt(area / n), border / (n + 2 * static_cast<double>(scene.surfaces.size())),
                         1e-6 * scene.diameter});
    double too_fine = 0, coarse_enough = std::numeric_limits<double>::infinity();
    std::vector<SurfaceTriangulation> best;
    std::size_t best_count = 0;
    for (int attempt = 0; attempt < 14; ++attempt) {
        auto pieces = triangulate_all(scene, h, min_angle, lines);
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

std::array<std::size_t, line_kinds.size()> edges_by_kind(const SurfaceTriangulation& triangulation)
{
    std::array<std::size_t, line_kinds.size()> counts{};
    for (const auto& line : triangulation.lines) ++counts[static_cast<std::size_t>(line.kind)];
    return counts;
}

/// The surfaces' triangulations, and which of them lines have changed.
struct LinedPieces {
    std::vector<SurfaceTriangulation> pieces;
    std::vector<std::uint8_t> changed;
};

LinedPieces with_lines(const Scene& scene, const PatchMesh& mesh, const LinesOfSurface& lines)
{
    const std::size_t n = scene.surfaces.size();
    LinedPieces result{std::vector<SurfaceTriangulation>(n), std::vector<std::uint8_t>(n, 0)};
    for_each_surface(scene, [&](SurfaceId s) {
        SurfaceTriangulation& piece = result.pieces[s.value];
        piece = triangulation_of(mesh, s);
        if (lines[s.value].empty()) return;
        const SurfaceTriangulation before = piece.lines.empty() ? triangulate_polygon(scene, s) : piece;
        SurfaceTriangulation lined = insert_lines({scene.surface(s).frame, scene.diameter}, before, lines[s.value]);
        // Lines outside of the surface, on its border, or there already, are no reason to lose what it has.
        if (edges_by_kind(lined) == edges_by_kind(before)) return;
        piece = std::move(lined);
        result.changed[s.value] = 1;
    });
    return result;
}

using SurfaceEdges = std::vector<std::vector<std::array<std::uint32_t, 2>>>;

/// The edges to halve, by surface, as many of the first as there is room for: each makes two triangles more at most.
SurfaceEdges edges_to_bisect(const PatchMesh& mesh, const RefinementPlan& plan, const LinedPieces& lined,
                             std::size_t room)
{
    const auto& pieces = lined.pieces;
    SurfaceEdges edges(pieces.size());
    std::vector<std::set<std::pair<std::uint32_t, std::uint32_t>>> chosen(pieces.size());
    for (const auto& [patch, k] : plan.bisections) {
        const SurfaceId s = mesh.surface(patch);
        if (lined.changed[s.value]) continue;
        const auto& corners = pieces[s.value].triangles[patch.value - mesh.patches_of(s).first];
        const std::uint32_t a = corners[k], b = corners[(k + 1U) % 3];
        if (room < 2) break;
        if (!chosen[s.value].insert(std::minmax(a, b)).second) continue;
        edges[s.value].push_back({a, b});
        room -= 2;
    }
    return edges;
}

}  // namespace

PatchMesh triangulate(const Scene& scene, const MeshingOptions& options, std::span<const SurfaceLine> lines)
{
    const LinesOfSurface lines_of = by_surface(scene, lines);
    if (options.max_elements > 0 && options.max_edge <= 0)
        return join(scene, triangulate_to_count(scene, options.max_elements, options.min_angle, lines_of));
    const double max_edge = options.max_edge > 0 ? options.max_edge : scene.diameter / 12;
    return join(scene, triangulate_all(scene, max_edge, options.min_angle, lines_of));
}

PatchMesh refined(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const MeshingOptions& options)
{
    const std::size_t most = options.max_elements > 0 ? std::max(options.max_elements, mesh.patch_count())
                                                      : std::numeric_limits<std::size_t>::max();
    std::span<const SurfaceLine> lines = plan.lines;
    LinesOfSurface lines_of = by_surface(scene, lines);
    LinedPieces lined = with_lines(scene, mesh, lines_of);
    while (count(lined.pieces) > most && !lines.empty()) {
        lines = lines.first(lines.size() * 3 / 4);
        lines_of = by_surface(scene, lines);
        lined = with_lines(scene, mesh, lines_of);
    }
    std::vector<SurfaceTriangulation>& pieces = lined.pieces;
    const SurfaceEdges edges = edges_to_bisect(mesh, plan, lined, most - std::min(most, count(pieces)));
    for_each_surface(scene, [&](SurfaceId s) {
        if (!edges[s.value].empty())
            pieces[s.value] = bisect_edges({scene.surface(s).frame, scene.diameter}, pieces[s.value], edges[s.value]);
    });
    return join(scene, pieces);
}

Refinement refine(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const MeshingOptions& options)
{
    PatchMesh next = refined(scene, mesh, plan, options);
    PatchTransfer transfer = overlap(mesh, PatchLocator(mesh), next);
    return {std::move(next), std::move(transfer)};
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
