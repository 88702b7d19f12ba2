#include "meshing/plane_groups.h"

#include "meshing/box_pairs.h"
#include "meshing/plane_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace patchlight {

namespace {

constexpr std::uint32_t none = Id<void>::invalid_value;

bool lies_in_plane(const SoupFace& face, const Vec3& origin, const Vec3& normal, const PolygonSoup& soup)
{
    // Tiny facets may fit any plane: their normals must agree, too.
    if (std::abs(glm::dot(face.normal, normal)) < 0.9) return false;
    return std::all_of(face.loop.begin(), face.loop.end(), [&](std::uint32_t v) {
        return std::abs(glm::dot(soup.vertices[v] - origin, normal)) <= soup.snap;
    });
}

Vec3 longest_edge(const SoupFace& face, const std::vector<Vec3>& vertices)
{
    Vec3 longest{0.0};
    for (std::size_t k = 0; k < face.loop.size(); ++k) {
        const Vec3 edge = vertices[face.loop[(k + 1) % face.loop.size()]] - vertices[face.loop[k]];
        // Opposite edges of a rectangle differ by rounding: the first shall win.
        if (glm::length(edge) > (1 + 1e-9) * glm::length(longest)) longest = edge;
    }
    return longest;
}

/// Faces that could share a plane, as lists of neighbours.
std::vector<std::vector<std::uint32_t>> coplanar_neighbours(const PolygonSoup& soup, const std::vector<Box3>& boxes)
{
    std::vector<std::vector<std::uint32_t>> neighbours(soup.faces.size());
    const auto pairs = touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t k) {
        const SoupFace &a = soup.faces[i], &b = soup.faces[k];
        return lies_in_plane(b, soup.vertices[a.loop[0]], a.normal, soup) ||
               lies_in_plane(a, soup.vertices[b.loop[0]], b.normal, soup);
    });
    for (const auto& [i, k] : pairs) {
        neighbours[i].push_back(k);
        neighbours[k].push_back(i);
    }
    return neighbours;
}

PlaneGroup grow_group(std::uint32_t seed, std::uint32_t id, const PolygonSoup& soup,
                      const std::vector<std::vector<std::uint32_t>>& neighbours, std::vector<std::uint32_t>& group_of)
{
    const SoupFace& face = soup.faces[seed];
    PlaneGroup group;
    group.frame = frame_with_normal(soup.vertices[face.loop[0]], face.normal, longest_edge(face, soup.vertices));
    group.faces = {seed};
    group_of[seed] = id;
    for (std::size_t next = 0; next < group.faces.size(); ++next) {
        for (const std::uint32_t other : neighbours[group.faces[next]]) {
            if (group_of[other] != none) continue;
            if (!lies_in_plane(soup.faces[other], group.frame.origin, group.frame.n, soup)) continue;
            group_of[other] = id;
            group.faces.push_back(other);
        }
    }
    std::sort(group.faces.begin(), group.faces.end());
    return group;
}

/// The groups each vertex lies in the plane of: by its own faces, where faces cross, or because it touches a face's
/// box there.
std::vector<std::vector<std::uint32_t>> groups_of_vertices(const PolygonSoup& soup, const EdgeChains& chains,
                                                           const std::vector<Box3>& boxes,
                                                           const std::vector<PlaneGroup>& groups,
                                                           const std::vector<std::uint32_t>& group_of)
{
    std::vector<std::vector<std::uint32_t>> result(soup.vertices.size());
    std::vector<Box3> points;
    for (const Vec3& v : soup.vertices) points.push_back({v, v});
    touching_pairs(boxes, points, [&](std::uint32_t face, std::uint32_t v) {
        const PlaneFrame& frame = groups[group_of[face]].frame;
        if (std::abs(glm::dot(soup.vertices[v] - frame.origin, frame.n)) <= soup.snap) {
            result[v].push_back(group_of[face]);
        }
        return false;
    });
    for (std::uint32_t face = 0; face < soup.faces.size(); ++face) {
        for (const std::uint32_t v : chains.split_loop(soup.faces[face])) result[v].push_back(group_of[face]);
    }
    for (const CrossingSegment& segment : chains.crossings()) {
        for (const std::uint32_t v : chains.chain(chains.index_of(segment.ends.first, segment.ends.second))) {
            for (const std::uint32_t face : segment.faces) result[v].push_back(group_of[face]);
        }
    }
    for (auto& list : result) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return result;
}

void find_contacts(const PolygonSoup& soup, const EdgeChains& chains,
                   const std::vector<std::vector<std::uint32_t>>& groups_of, std::vector<PlaneGroup>& groups)
{
    for (std::uint32_t v = 0; v < soup.vertices.size(); ++v) {
        for (const std::uint32_t g : groups_of[v]) groups[g].contact_vertices.push_back(v);
    }
    for (std::size_t e = 0; e < chains.edges().size(); ++e) {
        const auto chain = chains.chain(e);
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
            std::vector<std::uint32_t> both;
            std::set_intersection(groups_of[chain[k]].begin(), groups_of[chain[k]].end(),
                                  groups_of[chain[k + 1]].begin(), groups_of[chain[k + 1]].end(),
                                  std::back_inserter(both));
            for (const std::uint32_t g : both) groups[g].contact_edges.push_back(std::minmax(chain[k], chain[k + 1]));
        }
    }
    for (PlaneGroup& group : groups) {
        auto& edges = group.contact_edges;
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    }
}

}  // namespace

std::vector<PlaneGroup> make_plane_groups(const PolygonSoup& soup, const EdgeChains& chains)
{
    std::vector<Box3> boxes;
    for (const SoupFace& face : soup.faces) boxes.push_back(Box3::around(face.loop, soup.vertices, soup.snap));
    const auto neighbours = coplanar_neighbours(soup, boxes);
    std::vector<std::uint32_t> order(soup.faces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return soup.faces[a].area > soup.faces[b].area; });
    std::vector<std::uint32_t> group_of(soup.faces.size(), none);
    std::vector<PlaneGroup> groups;
    for (const std::uint32_t face : order) {
        if (group_of[face] != none) continue;
        groups.push_back(grow_group(face, static_cast<std::uint32_t>(groups.size()), soup, neighbours, group_of));
    }
    find_contacts(soup, chains, groups_of_vertices(soup, chains, boxes, groups, group_of), groups);
    return groups;
}

}  // namespace patchlight
