#include "meshing/patch_topology.h"
#include "meshing/surface_triangulation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

namespace patchlight {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexHandle = OpenMesh::VertexHandle;
using EdgeHandle = OpenMesh::EdgeHandle;
using FaceHandle = OpenMesh::FaceHandle;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;

/// The triangulation of one surface while it is being refined.
class SurfaceRefinement {
public:
    SurfaceRefinement(const MeshingPlane& plane, const SurfaceTriangulation& triangulation, const TargetEdge& target,
                      double min_angle)
        : plane_(plane), target_(target), cosine_bound_(std::cos(min_angle * std::numbers::pi / 180))
    {
        for (const Vec3& p : triangulation.positions) add_vertex(p);
        for (const auto& t : triangulation.triangles) {
            const auto handle = [](std::uint32_t v) { return VertexHandle(static_cast<int>(v)); };
            mesh_.add_face(handle(t[0]), handle(t[1]), handle(t[2]));
        }
    }

    void refine()
    {
        const std::size_t before = mesh_.n_vertices();
        for (const FaceHandle face : mesh_.faces()) work_.push_back(face);
        while (!work_.empty()) {
            const FaceHandle face = work_.front();
            work_.pop_front();
            while (too_long(face)) insert_circumcentre(face);
        }
        // Angles come second, and never make more points than sizes did: an angle that the input forces could
        // ask for ever.
        std::size_t left = mesh_.n_vertices() - before + before / 8;
        for (const FaceHandle face : mesh_.faces()) work_.push_back(face);
        while (!work_.empty() && left > 0) {
            const FaceHandle face = work_.front();
            work_.pop_front();
            for (int tries = 0; tries < 4 && left > 0 && too_sharp(face); ++tries, --left) insert_circumcentre(face);
        }
    }

    SurfaceTriangulation result() const
    {
        SurfaceTriangulation out;
        out.positions.reserve(mesh_.n_vertices());
        for (const VertexHandle v : mesh_.vertices()) out.positions.push_back(mesh_.point(v));
        out.triangles.reserve(mesh_.n_faces());
        for (const FaceHandle face : mesh_.faces()) {
            const auto c = corners(face);
            out.triangles.push_back({static_cast<std::uint32_t>(c[0].idx()), static_cast<std::uint32_t>(c[1].idx()),
                                     static_cast<std::uint32_t>(c[2].idx())});
        }
        return out;
    }

private:
    VertexHandle add_vertex(const Vec3& p)
    {
        flat_.push_back(plane_.to_plane(p));
        return mesh_.add_vertex(p);
    }

    const Vec2& at(VertexHandle v) const { return flat_[static_cast<std::size_t>(v.idx())]; }

    std::array<VertexHandle, 3> corners(FaceHandle face) const
    {
        const HalfedgeHandle h = mesh_.halfedge_handle(face);
        return {mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h),
                mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h))};
    }

    double length2(HalfedgeHandle h) const
    {
        const Vec2 d = at(mesh_.to_vertex_handle(h)) - at(mesh_.from_vertex_handle(h));
        return glm::dot(d, d);
    }

    /// Ties go to the lower edge, so that a path of longest edges ends.
    HalfedgeHandle longest(FaceHandle face) const
    {
        HalfedgeHandle h = mesh_.halfedge_handle(face), best = h;
        for (int k = 0; k < 2; ++k) {
            h = mesh_.next_halfedge_handle(h);
            const double l = length2(h), b = length2(best);
            if (l > b || (l == b && mesh_.edge_handle(h).idx() < mesh_.edge_handle(best).idx())) best = h;
        }
        return best;
    }

    bool too_long(FaceHandle face) const
    {
        const auto c = corners(face);
        const Vec2 middle = plane_.diameter * (at(c[0]) + at(c[1]) + at(c[2])) / 3.0;
        const double target = target_(middle) / plane_.diameter * (1 + 1e-9);
        return length2(longest(face)) > target * target;
    }

    /// An angle below the bound that isn't between two edges of the border.
    bool too_sharp(FaceHandle face) const
    {
        HalfedgeHandle h = mesh_.halfedge_handle(face);
        for (int k = 0; k < 3; ++k, h = mesh_.next_halfedge_handle(h)) {
            const HalfedgeHandle before = mesh_.prev_halfedge_handle(h);
            const Vec2 apex = at(mesh_.from_vertex_handle(h));
            const Vec2 a = at(mesh_.to_vertex_handle(h)) - apex, b = at(mesh_.from_vertex_handle(before)) - apex;
            if (glm::dot(a, b) > cosine_bound_ * std::sqrt(glm::dot(a, a) * glm::dot(b, b)))
                return !(on_border(h) && on_border(before));
        }
        return false;
    }

    bool on_border(HalfedgeHandle h) const { return mesh_.is_boundary(mesh_.edge_handle(h)); }

    /// Puts a vertex into the circumcentre of a face, or, where a border lies in between or too near, into the
    /// middle of that border's edge (Ruppert's rule).
    void insert_circumcentre(FaceHandle face)
    {
        const auto c = corners(face);
        const Vec2 a = at(c[1]) - at(c[0]), b = at(c[2]) - at(c[0]);
        const double aa = glm::dot(a, a), bb = glm::dot(b, b), twice = 2 * (a.x * b.y - a.y * b.x);
        const Vec2 centre = plane_.rounded(at(c[0]) + Vec2(b.y * aa - a.y * bb, a.x * bb - b.x * aa) / twice);

        const auto [target, blocking] = walk(face, centre);
        if (blocking.is_valid()) return split_edge(blocking);
        HalfedgeHandle h = mesh_.halfedge_handle(target);
        for (int k = 0; k < 3; ++k, h = mesh_.next_halfedge_handle(h)) {
            const Vec2 u = at(mesh_.from_vertex_handle(h)) - centre, v = at(mesh_.to_vertex_handle(h)) - centre;
            if (on_border(h) && glm::dot(u, v) <= 0) return split_edge(h);
            // On an edge it would leave a triangle without area.
            if (u.x * v.y - u.y * v.x < 1e-3 * length2(h)) return split_edge(longest(target));
        }
        const VertexHandle vertex = add_vertex(plane_.lift(centre));
        mesh_.split(target, vertex);
        settle(vertex);
    }

    /// The face that contains q, or the border edge that stops the way to it.
    std::pair<FaceHandle, HalfedgeHandle> walk(FaceHandle face, const Vec2& q) const
    {
        HalfedgeHandle entered;
        for (;;) {
            HalfedgeHandle h = mesh_.halfedge_handle(face), way_out;
            for (int k = 0; k < 3; ++k, h = mesh_.next_halfedge_handle(h))
                if (h != entered && cross2(at(mesh_.from_vertex_handle(h)), at(mesh_.to_vertex_handle(h)), q) < 0)
                    way_out = h;
            if (!way_out.is_valid() || on_border(way_out)) return {face, way_out};
            entered = mesh_.opposite_halfedge_handle(way_out);
            face = mesh_.face_handle(entered);
        }
    }

    void split_edge(HalfedgeHandle h)
    {
        const VertexHandle middle =
            add_vertex(0.5 * (mesh_.point(mesh_.from_vertex_handle(h)) + mesh_.point(mesh_.to_vertex_handle(h))));
        mesh_.split(mesh_.edge_handle(h), middle);
        settle(middle);
    }

    void settle(VertexHandle vertex)
    {
        restore_delaunay(vertex);
        for (const auto around : mesh_.vf_range(vertex)) work_.push_back(around);
    }

    /// Lawson's flips outward from a new vertex.
    void restore_delaunay(VertexHandle centre)
    {
        std::vector<HalfedgeHandle> opposite;
        for (const auto face : mesh_.vf_range(centre)) opposite.push_back(facing(face, centre));
        while (!opposite.empty()) {
            const HalfedgeHandle h = opposite.back();
            opposite.pop_back();
            if (on_border(h)) continue;
            const HalfedgeHandle twin = mesh_.opposite_halfedge_handle(h);
            const VertexHandle far = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(twin));
            const VertexHandle a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
            if (!must_flip(centre, a, b, far) || !mesh_.is_flip_ok(mesh_.edge_handle(h))) continue;
            mesh_.flip(mesh_.edge_handle(h));
            for (const auto face : mesh_.vf_range(centre)) {
                const auto c = corners(face);
                if (std::find(c.begin(), c.end(), far) != c.end()) opposite.push_back(facing(face, centre));
            }
        }
    }

    HalfedgeHandle facing(FaceHandle face, VertexHandle apex) const
    {
        HalfedgeHandle h = mesh_.halfedge_handle(face);
        while (mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)) != apex) h = mesh_.next_halfedge_handle(h);
        return h;
    }

    /// The edge ab of the triangle (centre, a, b), with `far` across it: illegal, and the flip leaves no bad triangle.
    bool must_flip(VertexHandle centre, VertexHandle a, VertexHandle b, VertexHandle far) const
    {
        const auto point = [&](VertexHandle v) { return Kernel::Point_2(at(v).x, at(v).y); };
        const auto p = point(centre), q = point(a), r = point(b), s = point(far);
        return CGAL::side_of_oriented_circle(p, q, r, s) == CGAL::ON_POSITIVE_SIDE &&
               CGAL::orientation(p, q, s) == CGAL::LEFT_TURN && CGAL::orientation(p, s, r) == CGAL::LEFT_TURN;
    }

    MeshingPlane plane_;
    const TargetEdge& target_;
    double cosine_bound_;
    TriMesh mesh_;
    std::vector<Vec2> flat_;
    std::deque<FaceHandle> work_;
};

}  // namespace

SurfaceTriangulation triangulation_of(const PatchMesh& mesh, SurfaceId surface)
{
    const auto vertices = mesh.vertices_of(surface);
    SurfaceTriangulation result;
    for (const VertexId v : vertices) result.positions.push_back(mesh.position(v));
    for (const PatchId p : mesh.patches_of(surface)) {
        const auto c = mesh.corners(p);
        result.triangles.push_back(
            {c[0].value - vertices.first, c[1].value - vertices.first, c[2].value - vertices.first});
    }
    return result;
}

SurfaceTriangulation refine_triangulation(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                          const TargetEdge& target, double min_angle)
{
    SurfaceRefinement refinement(plane, triangulation, target, min_angle);
    refinement.refine();
    return refinement.result();
}

}  // namespace patchlight
