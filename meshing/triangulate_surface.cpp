#include "meshing/surface_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <deque>
#include <map>
#include <numbers>

namespace patchlight {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Delaunay_mesh_vertex_base_2<Kernel>>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Mesher = CGAL::Delaunay_mesher_2<Triangulation, Criteria>;
using FaceHandle = Triangulation::Face_handle;
using VertexHandle = Triangulation::Vertex_handle;

constexpr int made_here = -1;  // vertices that the mesher adds have no index into Scene::vertices

Triangulation constrained(const Scene& scene, const Surface& surface)
{
    Triangulation cdt;
    for (const auto& loop : surface.loops) {
        std::vector<VertexHandle> handles;
        for (const std::uint32_t index : loop) {
            const Vec2 q = surface.frame.to_plane(scene.vertices[index]);
            const VertexHandle v = cdt.insert(Point(q.x, q.y));
            v->info() = static_cast<int>(index);
            handles.push_back(v);
        }
        for (std::size_t i = 0; i < handles.size(); ++i)
            if (handles[i] != handles[(i + 1) % handles.size()])
                cdt.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    }
    return cdt;
}

/// Marks the faces that an odd number of constraints separates from the outside; returns a point in each
/// connected piece of the rest (the mesher must know the holes by a point).
std::vector<Point> mark_domain(Triangulation& cdt)
{
    std::map<FaceHandle, int> level;
    std::vector<Point> holes;
    std::deque<std::pair<FaceHandle, int>> starts{{cdt.infinite_face(), 0}};
    while (!starts.empty()) {
        const auto [seed, depth] = starts.front();
        starts.pop_front();
        if (level.contains(seed)) continue;
        double largest = 0;
        Point inside;
        std::deque<FaceHandle> piece{seed};
        level[seed] = depth;
        while (!piece.empty()) {
            const FaceHandle face = piece.front();
            piece.pop_front();
            face->set_in_domain(depth % 2 == 1);
            if (!cdt.is_infinite(face)) {
                const auto triangle = cdt.triangle(face);
                if (const double area = CGAL::to_double(triangle.area()); area > largest) {
                    largest = area;
                    inside = CGAL::centroid(triangle);
                }
            }
            for (int i = 0; i < 3; ++i) {
                const FaceHandle next = face->neighbor(i);
                if (level.contains(next)) continue;
                if (cdt.is_constrained({face, i})) {
                    starts.emplace_back(next, depth + 1);
                } else {
                    level[next] = depth;
                    piece.push_back(next);
                }
            }
        }
        if (depth % 2 == 0 && depth > 0 && largest > 0) holes.push_back(inside);
    }
    return holes;
}

SurfaceTriangulation extract(const Scene& scene, const Surface& surface, const Triangulation& cdt)
{
    SurfaceTriangulation result;
    // A vertex where loops touch has several fans of patches: each fan gets a vertex of its own, so that the
    // patches are a manifold. Keyed by the first face of the fan, counter-clockwise.
    std::map<std::pair<VertexHandle, FaceHandle>, std::uint32_t> index_of;
    const auto first_of_fan = [&](VertexHandle v, FaceHandle face) {
        const FaceHandle start = face;
        for (;;) {
            const FaceHandle before = face->neighbor(Triangulation::ccw(face->index(v)));
            if (!before->is_in_domain() || before == start) return before == start ? v->face() : face;
            face = before;
        }
    };
    for (const FaceHandle face : cdt.finite_face_handles()) {
        if (!face->is_in_domain()) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (int k = 0; k < 3; ++k) {
            const VertexHandle v = face->vertex(k);
            const auto [entry, added] = index_of.try_emplace({v, first_of_fan(v, face)},
                                                             static_cast<std::uint32_t>(result.positions.size()));
            if (added)
                result.positions.push_back(v->info() == made_here
                                               ? surface.frame.lift({v->point().x(), v->point().y()})
                                               : scene.vertices[static_cast<std::size_t>(v->info())]);
            triangle[static_cast<std::size_t>(k)] = entry->second;
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

bool narrow(const Scene& scene, const Surface& surface, double max_edge)
{
    double border = 0;
    for (const auto& loop : surface.loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            border += glm::distance(scene.vertices[loop[i]], scene.vertices[loop[(i + 1) % loop.size()]]);
    const double longest = max_edge > 0 ? max_edge : border / 4;
    return 2 * surface.area / border < longest / 60;
}

/// Longest edges bisected by splitting constraints alone, for surfaces too narrow for an angle bound.
void split_long_constraints(Triangulation& cdt, double max_edge)
{
    if (max_edge <= 0) return;
    std::deque<std::pair<VertexHandle, VertexHandle>> edges;
    for (const auto& edge : cdt.constrained_edges())
        edges.emplace_back(edge.first->vertex(Triangulation::cw(edge.second)),
                           edge.first->vertex(Triangulation::ccw(edge.second)));
    while (!edges.empty()) {
        const auto [a, b] = edges.front();
        edges.pop_front();
        if (CGAL::squared_distance(a->point(), b->point()) <= max_edge * max_edge) continue;
        FaceHandle face;
        int i = 0;
        if (!cdt.is_edge(a, b, face, i)) continue;
        const VertexHandle m = cdt.insert(CGAL::midpoint(a->point(), b->point()), Triangulation::EDGE, face, i);
        m->info() = made_here;
        edges.emplace_back(a, m);
        edges.emplace_back(m, b);
    }
}

}  // namespace

SurfaceTriangulation triangulate_surface(const Scene& scene, SurfaceId id, double max_edge, double min_angle)
{
    const Surface& surface = scene.surface(id);
    Triangulation cdt = constrained(scene, surface);
    if (max_edge <= 0) {
        mark_domain(cdt);
    } else if (narrow(scene, surface, max_edge)) {
        split_long_constraints(cdt, max_edge);
        mark_domain(cdt);
    } else {
        const std::vector<Point> holes = mark_domain(cdt);
        const double sine = std::sin(min_angle * std::numbers::pi / 180);
        std::map<VertexHandle, int> input;
        for (const VertexHandle v : cdt.finite_vertex_handles()) input[v] = v->info();
        Mesher mesher(cdt, Criteria(sine * sine, max_edge));
        mesher.set_seeds(holes.begin(), holes.end(), false);
        mesher.refine_mesh();
        for (const VertexHandle v : cdt.finite_vertex_handles()) {
            const auto known = input.find(v);
            v->info() = known == input.end() ? made_here : known->second;
        }
    }
    return extract(scene, surface, cdt);
}

}  // namespace patchlight
