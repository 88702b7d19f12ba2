#include "meshing/edge_chains.h"

#include "meshing/box_pairs.h"
#include "meshing/vertex_grid.h"

#include <algorithm>
#include <array>
#include <optional>

namespace patchlight {

namespace {

using Edge = EdgeChains::Edge;

std::vector<Edge> all_edges(const std::vector<SoupFace>& faces, const std::vector<CrossingSegment>& crossings)
{
    std::vector<Edge> edges;
    for (const CrossingSegment& segment : crossings) edges.push_back(segment.ends);
    for (const SoupFace& face : faces) {
        for (std::size_t k = 0; k < face.loop.size(); ++k) {
            edges.push_back(std::minmax(face.loop[k], face.loop[(k + 1) % face.loop.size()]));
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

std::vector<Box3> edge_boxes(const std::vector<Edge>& edges, const std::vector<Vec3>& vertices, double margin)
{
    std::vector<Box3> boxes;
    for (const auto& [a, b] : edges) boxes.push_back(Box3::around(std::array{a, b}, vertices, margin));
    return boxes;
}

/// Where two edges cross, away from their ends. Coordinates that one of them holds fixed are taken from it.
std::optional<Vec3> crossing(const Edge& first, const Edge& second, const std::vector<Vec3>& vertices, double snap)
{
    const Vec3 &p = vertices[first.first], &q = vertices[second.first];
    const Vec3 d = vertices[first.second] - p, e = vertices[second.second] - q;
    const Vec3 n = glm::cross(d, e);
    const double n2 = glm::dot(n, n);
    if (!(n2 > 1e-24 * glm::dot(d, d) * glm::dot(e, e))) return {};
    const double s = glm::dot(glm::cross(q - p, e), n) / n2, t = glm::dot(glm::cross(q - p, d), n) / n2;
    if (!(s > 0 && s < 1 && t > 0 && t < 1)) return {};
    const Vec3 on_first = p + s * d, on_second = q + t * e;
    if (glm::distance(on_first, on_second) > snap) return {};
    Vec3 point;
    for (int k = 0; k < 3; ++k) {
        point[k] = d[k] == 0 ? p[k] : e[k] == 0 ? q[k] : 0.5 * (on_first[k] + on_second[k]);
    }
    return point;
}

/// A vertex that divides an edge.
struct Division {
    std::uint32_t edge;
    std::uint32_t vertex;
    auto operator<=>(const Division&) const = default;
};

/// Appends crossing points to the vertices.
std::vector<Division> divide_at_crossings(const std::vector<Edge>& edges, const std::vector<Box3>& boxes,
                                          PolygonSoup& soup)
{
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 2>> crossed;
    touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t k) {
        const Edge &a = edges[i], &b = edges[k];
        if (a.first == b.first || a.first == b.second || a.second == b.first || a.second == b.second) return false;
        if (const auto point = crossing(a, b, soup.vertices, soup.snap)) {
            points.push_back(*point);
            crossed.push_back({i, k});
        }
        return false;
    });
    const std::vector<std::uint32_t> welded = weld_points(points, soup.snap, soup.vertices);
    std::vector<Division> divisions;
    for (std::size_t k = 0; k < points.size(); ++k) {
        for (const std::uint32_t edge : crossed[k]) {
            if (edges[edge].first != welded[k] && edges[edge].second != welded[k])
                divisions.push_back({edge, welded[k]});
        }
    }
    return divisions;
}

double along(const Edge& edge, const Vec3& p, const std::vector<Vec3>& vertices)
{
    const Vec3 d = vertices[edge.second] - vertices[edge.first];
    return glm::dot(p - vertices[edge.first], d) / glm::dot(d, d);
}

std::vector<Division> divide_at_vertices(const std::vector<Edge>& edges, const std::vector<Box3>& boxes,
                                         const PolygonSoup& soup)
{
    std::vector<Box3> points;
    for (const Vec3& v : soup.vertices) points.push_back({v, v});
    std::vector<Division> divisions;
    touching_pairs(boxes, points, [&](std::uint32_t i, std::uint32_t v) {
        const Edge& edge = edges[i];
        if (edge.first == v || edge.second == v) return false;
        const Vec3& p = soup.vertices[v];
        const Vec3& a = soup.vertices[edge.first];
        const double t = along(edge, p, soup.vertices);
        if (!(t > 0 && t < 1)) return false;
        if (glm::distance(a + t * (soup.vertices[edge.second] - a), p) <= soup.snap) divisions.push_back({i, v});
        return false;
    });
    return divisions;
}

}  // namespace

EdgeChains::EdgeChains(PolygonSoup& soup, SceneReport& report)
{
    const auto input_vertices = static_cast<std::uint32_t>(soup.vertices.size());
    crossings_ = crossing_segments(soup, report);
    edges_ = all_edges(soup.faces, crossings_);
    const std::vector<Box3> boxes = edge_boxes(edges_, soup.vertices, soup.snap);
    std::vector<Division> divisions = divide_at_crossings(edges_, boxes, soup);
    const std::vector<Division> on_edges = divide_at_vertices(edges_, boxes, soup);
    divisions.insert(divisions.end(), on_edges.begin(), on_edges.end());
    std::sort(divisions.begin(), divisions.end());
    divisions.erase(std::unique(divisions.begin(), divisions.end()), divisions.end());

    chains_.resize(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) chains_[e] = {edges_[e].first};
    for (const Division& division : divisions) {
        chains_[division.edge].push_back(division.vertex);
        if (division.vertex < input_vertices) ++report.t_junctions;
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        std::sort(chains_[e].begin() + 1, chains_[e].end(), [&](std::uint32_t a, std::uint32_t b) {
            return along(edges_[e], soup.vertices[a], soup.vertices) <
                   along(edges_[e], soup.vertices[b], soup.vertices);
        });
        chains_[e].push_back(edges_[e].second);
    }
}

std::size_t EdgeChains::index_of(std::uint32_t a, std::uint32_t b) const
{
    const Edge edge = std::minmax(a, b);
    return static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), edge) - edges_.begin());
}

std::vector<std::uint32_t> EdgeChains::split_loop(const SoupFace& face) const
{
    std::vector<std::uint32_t> loop;
    for (std::size_t k = 0; k < face.loop.size(); ++k) {
        const std::uint32_t a = face.loop[k], b = face.loop[(k + 1) % face.loop.size()];
        const std::vector<std::uint32_t>& chain = chains_[index_of(a, b)];
        if (a < b) {
            loop.insert(loop.end(), chain.begin(), chain.end() - 1);
        } else {
            loop.insert(loop.end(), chain.rbegin(), chain.rend() - 1);
        }
    }
    return loop;
}

}  // namespace patchlight
