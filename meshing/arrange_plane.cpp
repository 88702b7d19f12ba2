#include "meshing/arrange_plane.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace patchlight {

namespace {

struct VertexInfo {
    std::uint32_t index = PlaneTriangle::black;
};
struct FaceInfo {
    std::uint32_t index = PlaneTriangle::black;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

/// How often each face's loop runs along an edge, from the smaller to the larger vertex.
using Flow = std::vector<std::pair<std::uint32_t, int>>;
using Edge = EdgeChains::Edge;
using FlowMap = std::map<Edge, Flow>;

void add(Flow& flow, std::uint32_t face, int amount)
{
    const auto at =
        std::lower_bound(flow.begin(), flow.end(), face, [](const auto& f, std::uint32_t id) { return f.first < id; });
    if (at == flow.end() || at->first != face) {
        flow.insert(at, {face, amount});
    } else if ((at->second += amount) == 0) {
        flow.erase(at);
    }
}

void add(Flow& flow, const Flow& more, int factor)
{
    for (const auto& [face, amount] : more) add(flow, face, factor * amount);
}

/// The plane's triangulation while it is made.
class PlaneBuilder {
public:
    PlaneBuilder(const PlaneGroup& group, PolygonSoup& soup) : group_(group), soup_(soup) {}

    void insert(const EdgeChains& chains);
    PlaneArrangement windings(const std::vector<std::uint32_t>& rank);

private:
    void insert_vertices();
    void spread_flows(const std::vector<std::pair<Edge, Triangulation::Constraint_id>>& constraints,
                      const FlowMap& wanted);
    std::vector<Flow> flood();
    std::uint32_t index(VertexHandle v) const { return v->info().index; }
    std::optional<PlaneTriangle> resolve(FaceHandle f, const Flow& winding, const std::vector<std::uint32_t>& rank,
                                         PlaneArrangement& result) const;

    const PlaneGroup& group_;
    PolygonSoup& soup_;
    Triangulation plane_;
    std::map<std::uint32_t, VertexHandle> handles_;
    FlowMap flows_;
};

void PlaneBuilder::insert_vertices()
{
    FaceHandle near;
    for (const std::uint32_t v : group_.contact_vertices) {
        const Vec2 q = group_.frame.to_plane(soup_.vertices[v]);
        const VertexHandle handle = plane_.insert({q.x, q.y}, near);
        if (handle->info().index == PlaneTriangle::black) handle->info().index = v;
        handles_[v] = handle;
        near = handle->face();
    }
}

void PlaneBuilder::insert(const EdgeChains& chains)
{
    insert_vertices();
    FlowMap wanted;
    for (const Edge& edge : group_.contact_edges) wanted[edge];
    for (const std::uint32_t face : group_.faces) {
        const std::vector<std::uint32_t> loop = chains.split_loop(soup_.faces[face]);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const std::uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
            add(wanted[std::minmax(a, b)], face, a < b ? 1 : -1);
        }
    }
    std::vector<std::pair<Edge, Triangulation::Constraint_id>> constraints;
    for (const auto& [edge, flow] : wanted) {
        const VertexHandle a = handles_.at(edge.first), b = handles_.at(edge.second);
        if (a != b) constraints.emplace_back(edge, plane_.insert_constraint(a, b));
    }
    // Where constraints crossed after all, within the snapping distance of a shared vertex: a vertex of its own.
    for (const VertexHandle v : plane_.finite_vertex_handles()) {
        if (v->info().index != PlaneTriangle::black) continue;
        v->info().index = static_cast<std::uint32_t>(soup_.vertices.size());
        soup_.vertices.push_back(group_.frame.lift({v->point().x(), v->point().y()}));
    }
    spread_flows(constraints, wanted);
}

void PlaneBuilder::spread_flows(const std::vector<std::pair<Edge, Triangulation::Constraint_id>>& constraints,
                                const FlowMap& wanted)
{
    for (const auto& [edge, id] : constraints) {
        const Flow& flow = wanted.at(edge);
        if (flow.empty()) continue;
        std::vector<std::uint32_t> along;
        for (auto v = plane_.vertices_in_constraint_begin(id); v != plane_.vertices_in_constraint_end(id); ++v) {
            along.push_back(index(*v));
        }
        const bool forward = along.front() == index(handles_.at(edge.first));
        for (std::size_t k = 0; k + 1 < along.size(); ++k) {
            const bool ascending = (along[k] < along[k + 1]) == forward;
            add(flows_[std::minmax(along[k], along[k + 1])], flow, ascending ? 1 : -1);
        }
    }
}

/// The winding numbers of every face of the triangulation, from outside in.
std::vector<Flow> PlaneBuilder::flood()
{
    std::vector<FaceHandle> order{plane_.infinite_face()};
    std::vector<Flow> windings(1);
    plane_.infinite_face()->info().index = 0;
    for (std::size_t next = 0; next < order.size(); ++next) {
        const FaceHandle f = order[next];
        for (int i = 0; i < 3; ++i) {
            const FaceHandle neighbour = f->neighbor(i);
            if (neighbour->info().index != PlaneTriangle::black) continue;
            neighbour->info().index = static_cast<std::uint32_t>(order.size());
            order.push_back(neighbour);
            Flow winding = windings[next];
            const VertexHandle a = f->vertex(Triangulation::ccw(i)), b = f->vertex(Triangulation::cw(i));
            if (!plane_.is_infinite(a) && !plane_.is_infinite(b)) {
                const std::uint32_t u = index(a), w = index(b);
                // f lies left of the edge from u to w: a loop along it winds round f, not round the neighbour.
                if (const auto flow = flows_.find(std::minmax(u, w)); flow != flows_.end()) {
                    add(winding, flow->second, u < w ? -1 : 1);
                }
            }
            windings.push_back(std::move(winding));
        }
    }
    return windings;
}

std::optional<PlaneTriangle> PlaneBuilder::resolve(FaceHandle f, const Flow& winding,
                                                   const std::vector<std::uint32_t>& rank,
                                                   PlaneArrangement& result) const
{
    PlaneTriangle triangle;
    std::vector<std::uint32_t> fronts, backs;
    for (const auto& [face, times] : winding) {
        const bool faces_up = glm::dot(soup_.faces[face].normal, group_.frame.n) > 0;
        const bool two_sided = soup_.materials[soup_.faces[face].material.value].two_sided;
        if (times != (faces_up ? 1 : -1)) result.self_crossing.push_back(face);
        if (faces_up || two_sided) fronts.push_back(face);
        if (!faces_up || two_sided) backs.push_back(face);
    }
    const auto best = [&](const std::vector<std::uint32_t>& faces) {
        if (faces.empty()) return PlaneTriangle::black;
        return *std::min_element(faces.begin(), faces.end(),
                                 [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; });
    };
    triangle.front = best(fronts);
    triangle.back = best(backs);
    if (triangle.front == PlaneTriangle::black && triangle.back == PlaneTriangle::black) return {};
    for (const auto* side : {&fronts, &backs}) {
        for (std::size_t i = 0; i < side->size(); ++i) {
            for (std::size_t k = i + 1; k < side->size(); ++k) result.overlaps.emplace_back((*side)[i], (*side)[k]);
        }
    }
    for (int i = 0; i < 3; ++i) triangle.vertices[static_cast<std::size_t>(i)] = index(f->vertex(i));
    std::rotate(triangle.vertices.begin(), std::min_element(triangle.vertices.begin(), triangle.vertices.end()),
                triangle.vertices.end());
    return triangle;
}

template <class Value>
void sort_unique(std::vector<Value>& values)
{
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

PlaneArrangement PlaneBuilder::windings(const std::vector<std::uint32_t>& rank)
{
    PlaneArrangement result;
    const std::vector<Flow> windings = flood();
    for (const FaceHandle f : plane_.finite_face_handles()) {
        if (auto triangle = resolve(f, windings[f->info().index], rank, result)) result.triangles.push_back(*triangle);
    }
    std::sort(result.triangles.begin(), result.triangles.end(),
              [](const PlaneTriangle& a, const PlaneTriangle& b) { return a.vertices < b.vertices; });
    sort_unique(result.overlaps);
    sort_unique(result.self_crossing);
    return result;
}

}  // namespace

PlaneArrangement arrange_plane(const PlaneGroup& group, const EdgeChains& chains,
                               const std::vector<std::uint32_t>& rank, PolygonSoup& soup)
{
    PlaneBuilder builder(group, soup);
    builder.insert(chains);
    return builder.windings(rank);
}

std::vector<std::uint32_t> rank_faces(const PolygonSoup& soup)
{
    std::vector<std::uint32_t> order(soup.faces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const SoupFace &p = soup.faces[a], &q = soup.faces[b];
        const bool p_emits = soup.materials[p.material.value].emits(),
                   q_emits = soup.materials[q.material.value].emits();
        if (p_emits != q_emits) return p_emits;
        return p.area < q.area;
    });
    std::vector<std::uint32_t> rank(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

}  // namespace patchlight
