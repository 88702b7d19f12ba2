#include "meshing/build_scene.h"

#include "meshing/arrange_plane.h"
#include "meshing/closedness.h"
#include "meshing/contact_lines.h"
#include "meshing/covered_parts.h"
#include "meshing/edge_chains.h"
#include "meshing/join_surfaces.h"
#include "meshing/plane_groups.h"
#include "meshing/polygon_soup.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace patchlight {

namespace {

// Light is passed on in single precision: beyond these it would overflow, or vanish with what it leaves after a few
// reflections.
constexpr double least_exitance = 1e-20, largest_exitance = 1e20;  // W/m², of the brightest

void require_light(const RawScene& raw, const PolygonSoup& soup, const SceneOptions& options)
{
    const auto brightness = [&](const SoupFace& face) {
        const Rgb& E = soup.materials[face.material.value].emission;
        return std::max({E.r, E.g, E.b});
    };
    const auto brightest = std::ranges::max_element(soup.faces, {}, brightness);
    const double E = brightness(*brightest);
    if (E == 0 && options.require_emitter) {
        throw SceneError("dark", fmt::format("{}: no emitter; set Ke or use --emitter MATERIAL=W", raw.file_name));
    }
    if (E != 0 && !(E >= least_exitance && E <= largest_exitance)) {
        throw SceneError("material",
                         fmt::format("{}: material {}: the brightest exitance of the scene is {:g} W/m2, but "
                                     "{:g} … {:g} is what can be computed with; give light in another unit",
                                     raw.file_name, soup.materials[brightest->material.value].name, E, least_exitance,
                                     largest_exitance));
    }
}

void require_uncovered_light(const RawScene& raw, const Scene& scene, const SceneOptions& options)
{
    const bool lit = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                 [&](const Surface& s) { return scene.materials[s.material.value].emits(); });
    if (!lit && options.require_emitter) {
        throw SceneError("dark", fmt::format("{}: every emitter is covered: its front meets nothing but backs; turn it "
                                             "round or use --two-sided MATERIAL",
                                             raw.file_name));
    }
}

std::size_t count_nonmanifold_edges(const PolygonSoup& soup, const EdgeChains& chains)
{
    std::map<EdgeChains::Edge, int> uses;
    for (const SoupFace& face : soup.faces) {
        const std::vector<std::uint32_t> loop = chains.split_loop(face);
        for (std::size_t k = 0; k < loop.size(); ++k) ++uses[std::minmax(loop[k], loop[(k + 1) % loop.size()])];
    }
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& entry) { return entry.second > 2; }));
}

void count(const PlaneArrangement& plane, SceneReport& report)
{
    report.coplanar_overlaps += plane.overlaps.size();
    report.self_crossing_faces += plane.self_crossing.size();
    for (const PlaneTriangle& t : plane.triangles) {
        if (t.front != PlaneTriangle::black && t.back != PlaneTriangle::black) ++report.opposed_pairs;
    }
}

/// Whether light can escape from where it is, and where no surface sees another.
void look_into_regions(std::vector<PlaneArrangement>& planes, const PolygonSoup& soup, SpaceRegions& regions,
                       LoadedScene& loaded)
{
    loaded.scene.closed = is_closed(planes, soup, regions);
    loaded.report.covered_area = blacken_covered_parts(planes, soup, regions);
}

void append(PlaneSurfaces plane, Scene& scene)
{
    const auto first = static_cast<std::uint32_t>(scene.surfaces.size());
    std::move(plane.surfaces.begin(), plane.surfaces.end(), std::back_inserter(scene.surfaces));
    for (SceneTriangle triangle : plane.triangles) {
        for (SurfaceId* side : {&triangle.front, &triangle.back}) {
            if (side->valid()) *side = SurfaceId(side->value + first);
        }
        scene.triangles.push_back(triangle);
    }
}

/// Keeps the vertices that triangles use, sorted by x, y, z.
void compact_vertices(Scene& scene)
{
    std::vector<bool> used(scene.vertices.size(), false);
    for (const SceneTriangle& t : scene.triangles) {
        for (const std::uint32_t v : t.vertices) used[v] = true;
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
        if (used[v]) order.push_back(v);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Vec3 &p = scene.vertices[a], &q = scene.vertices[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    });
    std::vector<std::uint32_t> renamed(used.size());
    std::vector<Vec3> sorted;
    for (const std::uint32_t v : order) {
        renamed[v] = static_cast<std::uint32_t>(sorted.size());
        sorted.push_back(scene.vertices[v]);
    }
    scene.vertices = std::move(sorted);
    for (SceneTriangle& t : scene.triangles) {
        for (std::uint32_t& v : t.vertices) v = renamed[v];
        std::rotate(t.vertices.begin(), std::min_element(t.vertices.begin(), t.vertices.end()), t.vertices.end());
    }
    for (Surface& surface : scene.surfaces) {
        for (auto& loop : surface.loops) {
            for (std::uint32_t& v : loop) v = renamed[v];
            std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        }
        std::sort(surface.loops.begin() + 1, surface.loops.end());
        surface.frame.origin = scene.vertices[surface.loops[0][0]];
    }
}

/// Surfaces by their loops, triangles by their surfaces: an order that only geometry decides.
void sort_scene(Scene& scene)
{
    std::vector<std::uint32_t> order(scene.surfaces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return scene.surfaces[a].loops < scene.surfaces[b].loops; });
    std::vector<std::uint32_t> renamed(order.size());
    std::vector<Surface> sorted;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        renamed[order[i]] = i;
        sorted.push_back(std::move(scene.surfaces[order[i]]));
    }
    scene.surfaces = std::move(sorted);
    for (SceneTriangle& t : scene.triangles) {
        for (SurfaceId* side : {&t.front, &t.back}) {
            if (side->valid()) *side = SurfaceId(renamed[side->value]);
        }
    }
    std::sort(scene.triangles.begin(), scene.triangles.end(), [](const SceneTriangle& a, const SceneTriangle& b) {
        const auto key = [](const SceneTriangle& t) {
            return std::tuple(std::min(t.front, t.back), t.front, t.vertices);
        };
        return key(a) < key(b);
    });
}

void add_views(const RawScene& raw, Scene& scene)
{
    scene.views = raw.views;
    for (View& view : scene.views) view.from -= scene.center;
}

}  // namespace

LoadedScene build_scene(const RawScene& raw, const SceneOptions& options)
{
    LoadedScene loaded;
    SceneReport& report = loaded.report;
    report.format = raw.format;
    report.vertices_read = raw.vertices.size();
    report.faces_read = raw.faces.size();
    report.warnings = raw.warnings;
    PolygonSoup soup = make_polygon_soup(raw, options, report);
    require_light(raw, soup, options);
    const EdgeChains chains(soup, report);
    report.nonmanifold_edges = count_nonmanifold_edges(soup, chains);
    const std::vector<std::uint32_t> rank = rank_faces(soup);

    const std::vector<PlaneGroup> groups = make_plane_groups(soup, chains);
    std::vector<PlaneArrangement> planes;
    for (const PlaneGroup& group : groups) {
        planes.push_back(arrange_plane(group, chains, rank, soup));
        count(planes.back(), report);
    }
    Scene& scene = loaded.scene;
    SpaceRegions regions = regions_of(planes, soup);
    look_into_regions(planes, soup, regions, loaded);
    std::uint32_t first = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        append(join_surfaces(groups[g], planes[g], soup, regions, first, options.join_objects), scene);
        first += static_cast<std::uint32_t>(planes[g].triangles.size());
    }
    scene.center = soup.center;
    scene.diameter = soup.diameter;
    scene.unit = options.unit;
    scene.vertices = std::move(soup.vertices);
    scene.materials = std::move(soup.materials);
    scene.objects = std::move(soup.objects);
    compact_vertices(scene);
    sort_scene(scene);
    add_views(raw, scene);
    require_uncovered_light(raw, scene, options);
    scene.contact_lines = find_contact_lines(scene, soup.snap);
    return loaded;
}

}  // namespace patchlight
