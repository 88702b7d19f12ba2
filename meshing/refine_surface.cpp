#include "meshing/patch_topology.h"
#include "meshing/surface_triangulation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
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
    SurfaceRefinement(const MeshingPlane& plane, const SurfaceTriangulation& triangulation) : plane_(plane)
    {
        const auto handle = [](std::uint32_t v) { return VertexHandle(static_cast<int>(v)); };
        for (const Vec3& p : triangulation.positions) add_vertex(p);
        for (const auto& t : triangulation.triangles) mesh_.add_face(handle(t[0]), handle(t[1]), handle(t[2]));
        kinds_.resize(mesh_.n_edges(), no_line);
        for (const auto& line : triangulation.lines) {
            const HalfedgeHandle h = mesh_.find_halfedge(handle(line.vertices[0]), handle(line.vertices[1]));
            kind(mesh_.edge_handle(h)) = static_cast<std::uint8_t>(line.kind);
        }
    }

    void refine(const TargetEdge& target, double min_angle)
    {
        target_ = &target;
        cosine_bound_ = std::cos(min_angle * std::numbers::pi / 180);
        for (const FaceHandle face : mesh_.faces()) work_.push_back(face);
        refine_sizes();
        // The rule in may_split() ends angles' demands; should rounding defeat it, this does.
        std::size_t left = 4 * mesh_.n_vertices() + 1000;
        for (const FaceHandle face : mesh_.faces()) work_.push_back(face);
        while (!work_.empty()) {
            const FaceHandle face = work_.front();
            work_.pop_front();
            shorten(face);
            while (left > 0 && too_sharp(face) && insert_circumcentre(face, shortest_edge(face))) --left;
        }
    }

    void bisect(std::span<const std::array<std::uint32_t, 2>> edges)
    {
        for (const auto& [a, b] : edges) {
            const VertexHandle from(static_cast<int>(a)), to(static_cast<int>(b));
            const HalfedgeHandle h = mesh_.find_halfedge(from, to);
            if (h.is_valid())
                split_edge(h);
            else
                insert_middle(from, to);
            work_.clear();
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
        for (const EdgeHandle edge : mesh_.edges()) {
            if (kind(edge) == no_line) continue;
            const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
            out.lines.push_back({{static_cast<std::uint32_t>(mesh_.from_vertex_handle(h).idx()),
                                  static_cast<std::uint32_t>(mesh_.to_vertex_handle(h).idx())},
                                 static_cast<LineKind>(kind(edge))});
        }
        return out;
    }

private:
    static constexpr std::uint8_t no_line = 0xff;
    static constexpr int most_tries = 1000;
    static constexpr double least_share = 1e-3;  ///< of a face's longest edge: what is split on its behalf

    std::uint8_t& kind(EdgeHandle edge) { return kinds_[static_cast<std::size_t>(edge.idx())]; }
    std::uint8_t kind(EdgeHandle edge) const { return kinds_[static_cast<std::size_t>(edge.idx())]; }

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
        const double target = (*target_)(middle) / plane_.diameter * (1 + 1e-9);
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
                return !(is_fixed(h) && is_fixed(before));
        }
        return false;
    }

    /// On the border or on a line: never flipped, never stepped over.
    bool is_fixed(HalfedgeHandle h) const
    {
        return mesh_.is_boundary(mesh_.edge_handle(h)) || kind(mesh_.edge_handle(h)) != no_line;
    }

    void refine_sizes()
    {
        while (!work_.empty()) {
            const FaceHandle face = work_.front();
            work_.pop_front();
            shorten(face);
        }
    }

    /// By circumcentres, which make good triangles; by halving its longest edge where they don't help it, so that it
    /// ends whatever rounding does. Needles stay long where halves would be no thicker than rounding.
    void shorten(FaceHandle face)
    {
        for (int tries = 0; tries < most_tries && too_long(face) && insert_circumcentre(face, 0);) ++tries;
        while (too_long(face) && split_edge(longest(face))) {}
    }

    double shortest_edge(FaceHandle face) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (const auto h : mesh_.fh_range(face)) least = std::min(least, length2(h));
        return std::sqrt(least);
    }

    /// Puts a vertex into the circumcentre of a face, or, where a border lies in between or too near, into the
    /// middle of that border's edge (Ruppert's rule). False when that would make an edge shorter than `no_shorter`, or
    /// a triangle without area.
    bool insert_circumcentre(FaceHandle face, double no_shorter)
    {
        const auto c = corners(face);
        const Vec2 a = at(c[1]) - at(c[0]), b = at(c[2]) - at(c[0]);
        const double aa = glm::dot(a, a), bb = glm::dot(b, b), twice = 2 * (a.x * b.y - a.y * b.x);
        const Vec2 centre = plane_.rounded(at(c[0]) + Vec2(b.y * aa - a.y * bb, a.x * bb - b.x * aa) / twice);

        auto [target, blocking] = walk(face, centre);
        if (!blocking.is_valid()) blocking = encroached(target, centre);
        if (blocking.is_valid()) {
            // Slivers along a border ask for halves of ever the same piece of it, and would not get shorter themselves.
            if (length2(blocking) < least_share * least_share * length2(longest(face))) blocking = longest(face);
            return may_split(blocking, no_shorter) && split_edge(blocking);
        }
        // On an edge it would leave a triangle without area. Borders and lines stay where they are.
        HalfedgeHandle touched;
        bool fits = true;
        for (const auto h : mesh_.fh_range(target)) {
            const Vec2 &u = at(mesh_.from_vertex_handle(h)), &v = at(mesh_.to_vertex_handle(h));
            if (!is_fixed(h) && cross2(u, v, centre) < 1e-3 * length2(h)) touched = h;
            fits = fits && MeshingPlane::is_thick(u, v, centre);
        }
        if (touched.is_valid() ? !may_divide(touched, centre) : !fits) return false;
        const VertexHandle vertex = add_vertex(plane_.lift(centre));
        if (touched.is_valid())
            split(mesh_.edge_handle(touched), vertex);
        else
            split(target, vertex);
        settle(vertex);
        return true;
    }

    /// The first border edge that has q in its diametral circle, among the faces that have q in their circumcircle
    /// and hang together with `start`, which contains q.
    HalfedgeHandle encroached(FaceHandle start, const Vec2& q) const
    {
        std::vector<FaceHandle> cavity{start};
        for (std::size_t i = 0; i < cavity.size(); ++i) {
            for (const auto h : mesh_.fh_range(cavity[i])) {
                if (is_fixed(h)) {
                    const Vec2 u = at(mesh_.from_vertex_handle(h)) - q, v = at(mesh_.to_vertex_handle(h)) - q;
                    if (glm::dot(u, v) <= 0) return h;
                    continue;
                }
                const FaceHandle next = mesh_.opposite_face_handle(h);
                if (std::find(cavity.begin(), cavity.end(), next) == cavity.end() && in_circumcircle(next, q))
                    cavity.push_back(next);
            }
        }
        return HalfedgeHandle();
    }

    bool in_circumcircle(FaceHandle face, const Vec2& q) const
    {
        const auto c = corners(face);
        const auto point = [](const Vec2& p) { return Kernel::Point_2(p.x, p.y); };
        return CGAL::side_of_oriented_circle(point(at(c[0])), point(at(c[1])), point(at(c[2])), point(q)) ==
               CGAL::ON_POSITIVE_SIDE;
    }

    /// Splitting a border edge for an angle's sake must not bring vertices nearer to each other than they are: at a
    /// sharp corner of the input both borders would ask each other for halves for ever [MillerPavWalkington03]. Half
    /// of the distance is let pass: corners above 30°, and corners of the input near a border, need it.
    bool may_split(HalfedgeHandle h, double no_shorter) const
    {
        if (no_shorter <= 0) return true;
        const HalfedgeHandle border = mesh_.is_boundary(h) ? h : mesh_.opposite_halfedge_handle(h);
        const HalfedgeHandle next = mesh_.next_halfedge_handle(border), before = mesh_.prev_halfedge_handle(border);
        const double half = 0.5 * std::sqrt(length2(h));
        const Vec2 a = at(mesh_.from_vertex_handle(border)), b = at(mesh_.to_vertex_handle(border));
        const double sine = std::min(sine_between(b, a, at(mesh_.to_vertex_handle(next))),
                                     sine_between(a, b, at(mesh_.from_vertex_handle(before))));
        return half * sine >= 0.5 * no_shorter;
    }

    /// Sine of the angle at `apex` of two border edges, 1 when it is obtuse.
    static double sine_between(const Vec2& apex, const Vec2& a, const Vec2& b)
    {
        const Vec2 u = a - apex, v = b - apex;
        if (glm::dot(u, v) <= 0) return 1;
        return std::abs(u.x * v.y - u.y * v.x) / std::sqrt(glm::dot(u, u) * glm::dot(v, v));
    }

    /// The face that contains q, or the border edge that stops the way to it. Should rounding lead the way round a
    /// corner for ever, the longest edge of the face that it began in: halving that one always helps.
    std::pair<FaceHandle, HalfedgeHandle> walk(FaceHandle face, const Vec2& q) const
    {
        const auto c = corners(face);
        const Vec2 start = (at(c[0]) + at(c[1]) + at(c[2])) / 3.0;
        const HalfedgeHandle last_resort = longest(face);
        HalfedgeHandle entered;
        for (std::size_t steps = 0; steps < mesh_.n_faces(); ++steps) {
            HalfedgeHandle way_out;
            double best = -std::numeric_limits<double>::infinity();
            for (const auto h : mesh_.fh_range(face)) {
                const Vec2 &a = at(mesh_.from_vertex_handle(h)), &b = at(mesh_.to_vertex_handle(h));
                if (h == entered || cross2(a, b, q) >= 0) continue;
                // The edge that the straight way crosses has its ends on either side.
                const double between = std::min(-cross2(start, q, a), cross2(start, q, b));
                if (between > best) {
                    best = between;
                    way_out = h;
                }
            }
            if (!way_out.is_valid() || is_fixed(way_out)) return {face, way_out};
            entered = mesh_.opposite_halfedge_handle(way_out);
            face = mesh_.face_handle(entered);
        }
        return {face, last_resort};
    }

    /// Halves an edge; false where that would leave a triangle without area.
    bool split_edge(HalfedgeHandle h)
    {
        const Vec3 place = middle_of(mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h));
        if (!may_divide(h, plane_.to_plane(place))) return false;
        const VertexHandle middle = add_vertex(place);
        split(mesh_.edge_handle(h), middle);
        settle(middle);
        return true;
    }

    Vec3 middle_of(VertexHandle a, VertexHandle b) const { return 0.5 * (mesh_.point(a) + mesh_.point(b)); }

    /// Both halves stay on the line, if it was one.
    void split(EdgeHandle edge, VertexHandle vertex)
    {
        const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
        const VertexHandle a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
        const std::uint8_t was = kind(edge);
        mesh_.split(edge, vertex);
        kinds_.resize(mesh_.n_edges(), no_line);
        for (const VertexHandle end : {a, b}) kind(mesh_.edge_handle(mesh_.find_halfedge(vertex, end))) = was;
    }

    void split(FaceHandle face, VertexHandle vertex)
    {
        mesh_.split(face, vertex);
        kinds_.resize(mesh_.n_edges(), no_line);
    }

    /// Whether triangles are left with area when an edge is divided at q.
    bool may_divide(HalfedgeHandle h, const Vec2& q) const
    {
        for (const HalfedgeHandle side : {h, mesh_.opposite_halfedge_handle(h)}) {
            if (mesh_.is_boundary(side)) continue;
            const Vec2& apex = at(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(side)));
            const Vec2 &from = at(mesh_.from_vertex_handle(side)), &to = at(mesh_.to_vertex_handle(side));
            if (!MeshingPlane::is_thick(from, q, apex) || !MeshingPlane::is_thick(q, to, apex)) return false;
        }
        return true;
    }

    /// A vertex in the middle of two that had an edge once; often it lies on the edge that flips put there instead.
    void insert_middle(VertexHandle a, VertexHandle b)
    {
        const Vec3 place = middle_of(a, b);
        const Vec2 middle = plane_.to_plane(place);
        const FaceHandle face = face_towards(a, middle);
        if (!face.is_valid()) return;
        HalfedgeHandle touched;
        for (const auto h : mesh_.fh_range(face))
            if (!MeshingPlane::is_thick(at(mesh_.from_vertex_handle(h)), at(mesh_.to_vertex_handle(h)), middle))
                touched = h;
        if (touched.is_valid() && (is_fixed(touched) || !may_divide(touched, middle))) return;
        const VertexHandle vertex = add_vertex(place);
        if (touched.is_valid())
            split(mesh_.edge_handle(touched), vertex);
        else
            split(face, vertex);
        settle(vertex);
    }

    /// The face that contains q, straight on from a vertex; none when something fixed lies in between.
    FaceHandle face_towards(VertexHandle start, const Vec2& q) const
    {
        HalfedgeHandle ahead;  // from the right of the way to its left
        for (const FaceHandle face : mesh_.vf_range(start)) {
            const HalfedgeHandle h = facing(face, start);
            if (cross2(at(start), at(mesh_.from_vertex_handle(h)), q) >= 0 &&
                cross2(at(start), q, at(mesh_.to_vertex_handle(h))) >= 0)
                ahead = h;
        }
        while (ahead.is_valid() &&
               cross2(at(mesh_.from_vertex_handle(ahead)), at(mesh_.to_vertex_handle(ahead)), q) < 0) {
            if (is_fixed(ahead)) return FaceHandle();
            ahead = mesh_.opposite_halfedge_handle(ahead);
            const VertexHandle apex = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(ahead));
            ahead = cross2(at(start), q, at(apex)) > 0 ? mesh_.next_halfedge_handle(ahead)
                                                       : mesh_.prev_halfedge_handle(ahead);
        }
        return ahead.is_valid() ? mesh_.face_handle(ahead) : FaceHandle();
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
            if (is_fixed(h)) continue;
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
               MeshingPlane::is_thick(at(centre), at(a), at(far)) && MeshingPlane::is_thick(at(centre), at(far), at(b));
    }

    MeshingPlane plane_;
    const TargetEdge* target_ = nullptr;
    double cosine_bound_ = 1;
    TriMesh mesh_;
    std::vector<std::uint8_t> kinds_;  // of edges
    std::vector<Vec2> flat_;
    std::deque<FaceHandle> work_;
};

}  // namespace

SurfaceTriangulation refine_triangulation(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                          const TargetEdge& target, double min_angle)
{
    SurfaceRefinement refinement(plane, triangulation);
    refinement.refine(target, min_angle);
    return refinement.result();
}

SurfaceTriangulation bisect_edges(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                  std::span<const std::array<std::uint32_t, 2>> edges)
{
    SurfaceRefinement refinement(plane, triangulation);
    refinement.bisect(edges);
    return refinement.result();
}

}  // namespace patchlight
