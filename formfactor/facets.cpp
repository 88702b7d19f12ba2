#include "formfactor/facets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace patchlight {

namespace {

using Loop = std::vector<std::uint32_t>;

/// Sines below this are taken for straight: the corner moves the polygon by less than snapping does.
constexpr double straight = 1e-10;

/// Negative where the loop turns to the right at its corner i, 0 where it runs straight on.
double turn_at(const std::vector<Vec3>& vertices, const Loop& loop, std::size_t i, const Vec3& normal)
{
    const std::size_t n = loop.size();
    const Vec3 along = vertices[loop[i]] - vertices[loop[(i + n - 1) % n]];
    const Vec3 next = vertices[loop[(i + 1) % n]] - vertices[loop[i]];
    const double sine = glm::dot(glm::cross(along, next), normal) / (glm::length(along) * glm::length(next));
    return std::abs(sine) <= straight ? 0 : sine;
}

bool convex(const std::vector<Vec3>& vertices, const Loop& loop, const Vec3& normal)
{
    for (std::size_t i = 0; i < loop.size(); ++i)
        if (turn_at(vertices, loop, i, normal) < 0) return false;
    return true;
}

/// Two loops that share the edge (a, b), ascending in the first: one loop around both. Empty unless it is simple.
Loop joined(const Loop& first, const Loop& second, std::uint32_t a, std::uint32_t b)
{
    Loop result;
    const auto start = static_cast<std::size_t>(std::ranges::find(first, b) - first.begin());
    for (std::size_t k = 0; k < first.size(); ++k) result.push_back(first[(start + k) % first.size()]);
    const auto other = static_cast<std::size_t>(std::ranges::find(second, a) - second.begin());
    for (std::size_t k = 1; k + 1 < second.size(); ++k) result.push_back(second[(other + k) % second.size()]);
    Loop sorted = result;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) return {};
    return result;
}

/// Joins loops across their edges, in the order of the edges' vertices, while the result is convex.
std::vector<Loop> join_convex(const std::vector<Vec3>& vertices, std::vector<Loop> loops, const Vec3& normal)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> left_of;  // directed edge: the loop on its left
    const auto enter = [&](std::size_t l) {
        for (std::size_t k = 0; k < loops[l].size(); ++k)
            left_of[{loops[l][k], loops[l][(k + 1) % loops[l].size()]}] = l;
    };
    for (std::size_t l = 0; l < loops.size(); ++l) enter(l);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, l] : left_of)
        if (edge.first < edge.second) edges.push_back(edge);
    for (const auto& [a, b] : edges) {
        const auto one = left_of.find({a, b}), two = left_of.find({b, a});
        if (one == left_of.end() || two == left_of.end() || one->second == two->second) continue;
        Loop both = joined(loops[one->second], loops[two->second], a, b);
        if (both.empty() || !convex(vertices, both, normal)) continue;
        const std::size_t kept = one->second, gone = two->second;
        loops[kept] = std::move(both);
        loops[gone].clear();
        left_of.erase({a, b});
        left_of.erase({b, a});
        enter(kept);
    }
    std::erase_if(loops, [](const Loop& l) { return l.empty(); });
    return loops;
}

Facet facet_of(const Scene& scene, const Loop& loop, SurfaceId surface)
{
    Facet facet;
    facet.surface = surface;
    facet.normal = scene.surface(surface).frame.n;
    for (std::size_t i = 0; i < loop.size(); ++i)
        if (turn_at(scene.vertices, loop, i, facet.normal) > 0) facet.corners.push_back(scene.vertices[loop[i]]);
    for (std::size_t k = 2; k < facet.corners.size(); ++k)
        facet.area +=
            0.5 * glm::length(glm::cross(facet.corners[k - 1] - facet.corners[0], facet.corners[k] - facet.corners[0]));
    return facet;
}

/// The scene's triangles over each surface, as loops seen from its front.
std::vector<std::vector<Loop>> triangles_of_surfaces(const Scene& scene)
{
    std::vector<std::vector<Loop>> result(scene.surfaces.size());
    for (const SceneTriangle& t : scene.triangles) {
        if (t.front.valid()) result[t.front.value].push_back({t.vertices[0], t.vertices[1], t.vertices[2]});
        if (t.back.valid()) result[t.back.value].push_back({t.vertices[0], t.vertices[2], t.vertices[1]});
    }
    return result;
}

bool is_one_facet(const Scene& scene, SurfaceId surface)
{
    const Surface& s = scene.surface(surface);
    return s.loops.size() == 1 && convex(scene.vertices, s.loops.front(), s.frame.n);
}

void add_facets(const Scene& scene, SurfaceId surface, std::vector<Loop> triangles, std::vector<Facet>& facets)
{
    const Surface& s = scene.surface(surface);
    const std::vector<Loop> loops = is_one_facet(scene, surface)
                                        ? std::vector<Loop>{s.loops.front()}
                                        : join_convex(scene.vertices, std::move(triangles), s.frame.n);
    for (const Loop& loop : loops) {
        Facet facet = facet_of(scene, loop, surface);
        if (facet.corners.size() >= 3) facets.push_back(std::move(facet));
    }
}

template <class Wanted>
std::vector<Facet> facets_where(const Scene& scene, const Wanted& wanted)
{
    std::vector<std::vector<Loop>> triangles = triangles_of_surfaces(scene);
    std::vector<Facet> facets;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (wanted(scene.surfaces[s], s)) add_facets(scene, SurfaceId(s), std::move(triangles[s]), facets);
    return facets;
}

}  // namespace

std::vector<Facet> facets_of(const Scene& scene, SurfaceId surface)
{
    return facets_where(scene, [&](const Surface&, std::size_t s) { return s == surface.value; });
}

std::vector<Facet> facets_of(const Scene& scene, ObjectId object)
{
    return facets_where(scene, [&](const Surface& s, std::size_t) { return s.object == object; });
}

std::vector<Facet> facets_of(const Scene& scene)
{
    return facets_where(scene, [](const Surface&, std::size_t) { return true; });
}

double total_area(std::span<const Facet> facets)
{
    double sum = 0;
    for (const Facet& facet : facets) sum += facet.area;
    return sum;
}

}  // namespace patchlight
