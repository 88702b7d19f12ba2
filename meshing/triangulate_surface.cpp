#include "meshing/surface_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <deque>
#include <map>

namespace patchlight {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;  // index into Scene::vertices
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;
using FaceHandle = Triangulation::Face_handle;
using VertexHandle = Triangulation::Vertex_handle;

constexpr int unknown = -1;

Triangulation constrained(const Scene& scene, const Surface& surface)
{
    const MeshingPlane plane{surface.frame, scene.diameter};
    Triangulation cdt;
    for (const auto& loop : surface.loops) {
        std::vector<VertexHandle> handles;
        for (const std::uint32_t index : loop) {
            const Vec2 q = plane.to_plane(scene.vertices[index]);
            const VertexHandle v = cdt.insert(Point(q.x, q.y));
            v->info() = index;
            handles.push_back(v);
        }
        for (std::size_t i = 0; i < handles.size(); ++i)
            if (handles[i] != handles[(i + 1) % handles.size()])
                cdt.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    }
    return cdt;
}

/// Marks the faces that an odd number of constraints separates from the outside.
void mark_domain(Triangulation& cdt)
{
    for (const FaceHandle face : cdt.all_face_handles()) face->info() = unknown;
    std::deque<std::pair<FaceHandle, int>> work{{cdt.infinite_face(), 0}};
    while (!work.empty()) {
        const auto [face, level] = work.front();
        work.pop_front();
        if (face->info() != unknown) continue;
        face->info() = level;
        for (int i = 0; i < 3; ++i) {
            const bool crossing = cdt.is_constrained({face, i});
            // Nearer levels first: a face belongs to the lowest level it is reached with.
            if (crossing)
                work.emplace_back(face->neighbor(i), level + 1);
            else
                work.emplace_front(face->neighbor(i), level);
        }
    }
}

bool in_domain(FaceHandle face)
{
    return face->info() % 2 == 1;
}

SurfaceTriangulation extract(const Scene& scene, const Triangulation& cdt)
{
    SurfaceTriangulation result;
    // A vertex where loops touch has several fans of patches: each fan gets a vertex of its own, so that the
    // patches are a manifold. Keyed by the first face of the fan, counter-clockwise.
    std::map<std::pair<VertexHandle, FaceHandle>, std::uint32_t> index_of;
    const auto first_of_fan = [&](VertexHandle v, FaceHandle face) {
        const FaceHandle start = face;
        for (;;) {
            const FaceHandle before = face->neighbor(Triangulation::ccw(face->index(v)));
            if (!in_domain(before) || before == start) return before == start ? v->face() : face;
            face = before;
        }
    };
    for (const FaceHandle face : cdt.finite_face_handles()) {
        if (!in_domain(face)) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (int k = 0; k < 3; ++k) {
            const VertexHandle v = face->vertex(k);
            const auto [entry, added] =
                index_of.try_emplace({v, first_of_fan(v, face)}, static_cast<std::uint32_t>(result.positions.size()));
            if (added) result.positions.push_back(scene.vertices[v->info()]);
            triangle[static_cast<std::size_t>(k)] = entry->second;
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

}  // namespace

SurfaceTriangulation triangulate_polygon(const Scene& scene, SurfaceId surface)
{
    Triangulation cdt = constrained(scene, scene.surface(surface));
    mark_domain(cdt);
    return extract(scene, cdt);
}

}  // namespace patchlight
