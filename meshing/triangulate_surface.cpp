#include "meshing/arrange_lines.h"
#include "meshing/surface_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <set>

namespace patchlight {

namespace {

constexpr std::uint32_t unnamed = 0xffffffffU;

struct VertexInfo {
    std::uint32_t point = unnamed;
};
struct FaceInfo {
    bool inside = false, reached = false;
    int winding = 0;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;
using FaceHandle = Triangulation::Face_handle;
using VertexHandle = Triangulation::Vertex_handle;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// The constrained Delaunay triangulation of an arrangement.
class ArrangementTriangulation {
public:
    explicit ArrangementTriangulation(LineArrangement lines) : lines_(std::move(lines))
    {
        std::vector<VertexHandle> handles;
        FaceHandle near;
        for (std::uint32_t i = 0; i < lines_.points.size(); ++i) {
            const VertexHandle v = cdt_.insert(Point(lines_.points[i].x, lines_.points[i].y), near);
            if (v->info().point == unnamed) v->info().point = i;
            handles.push_back(v);
            near = v->face();
        }
        std::vector<std::pair<const PlanePiece*, Triangulation::Constraint_id>> constraints;
        for (const PlanePiece& piece : lines_.pieces) {
            const VertexHandle a = handles[piece.points[0]], b = handles[piece.points[1]];
            if (a != b) constraints.emplace_back(&piece, cdt_.insert_constraint(a, b));
        }
        // Pieces that rounding lets cross after all get a point there.
        for (const VertexHandle v : cdt_.finite_vertex_handles()) {
            if (v->info().point != unnamed) continue;
            v->info().point = static_cast<std::uint32_t>(lines_.points.size());
            lines_.points.emplace_back(v->point().x(), v->point().y());
        }
        for (const auto& [piece, id] : constraints) name_edges(*piece, handles[piece->points[0]], id);
        mark_inside();
    }

    /// Triangles no thicker than rounding, which may have turned them over, between corners that lie all but on one
    /// straight line: with their longest edge on the border they are taken off, else that edge is flipped where it
    /// helps, else they are taken off by any edge on the border. The points given lie at `places`. Should nothing be
    /// left, nothing is taken.
    void mend(const MeshingPlane& plane, const std::vector<Vec3>& places)
    {
        std::vector<Vec2> at = lines_.points;
        for (std::size_t k = 0; k < places.size(); ++k) at[k] = plane.frame.to_plane(places[k]) / plane.diameter;
        std::vector<FaceHandle> taken;
        bool changed = true;
        for (int round = 0; changed && round < most_rounds; ++round) {
            changed = false;
            for (FaceHandle face : cdt_.finite_face_handles()) {
                if (!face->info().inside || thickness(at, corners(face)) > 0) continue;
                const int i = longest_edge(at, face);
                if (!is_border(face, i) && flip_helps(at, face, i)) {
                    cdt_.flip(face, i);
                } else if (is_border(face, 0) || is_border(face, 1) || is_border(face, 2)) {
                    face->info().inside = false;
                    taken.push_back(face);
                } else {
                    continue;
                }
                changed = true;
            }
        }
        const auto inside = [](FaceHandle face) { return face->info().inside; };
        if (std::ranges::none_of(cdt_.finite_face_handles(), inside))
            for (const FaceHandle face : taken) face->info().inside = true;
    }

    /// What lies inside. The points given lie at `places`, those that came since are lifted from the plane.
    SurfaceTriangulation extract(const MeshingPlane& plane, const std::vector<Vec3>& places) const;

private:
    void name_edges(const PlanePiece& piece, VertexHandle start, Triangulation::Constraint_id id)
    {
        std::vector<std::uint32_t> chain;
        for (auto v = cdt_.vertices_in_constraint_begin(id); v != cdt_.vertices_in_constraint_end(id); ++v)
            chain.push_back((*v)->info().point);
        if (chain.front() != start->info().point) std::ranges::reverse(chain);
        for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
            if (piece.border)
                border_[std::minmax(chain[k], chain[k + 1])] += chain[k] < chain[k + 1] ? 1 : -1;
            else
                line_edges_.push_back({{chain[k], chain[k + 1]}, piece.kind});
        }
    }

    /// How often the border runs from a to b, less how often back. Where rounding closed a gap it does both.
    int runs(VertexHandle a, VertexHandle b) const
    {
        const std::uint32_t u = a->info().point, v = b->info().point;
        const auto found = border_.find(std::minmax(u, v));
        return found == border_.end() ? 0 : u < v ? found->second : -found->second;
    }
    bool on_border(VertexHandle a, VertexHandle b) const { return runs(a, b) != 0; }

    /// Inside is what the border winds round: found from outside in.
    void mark_inside()
    {
        if (cdt_.dimension() < 2) return;
        std::vector<FaceHandle> work{cdt_.infinite_face()};
        work.front()->info().reached = true;
        while (!work.empty()) {
            const FaceHandle face = work.back();
            work.pop_back();
            for (int i = 0; i < 3; ++i) {
                const FaceHandle next = face->neighbor(i);
                if (next->info().reached) continue;
                const VertexHandle a = face->vertex(Triangulation::ccw(i)), b = face->vertex(Triangulation::cw(i));
                const bool finite = !cdt_.is_infinite(a) && !cdt_.is_infinite(b);
                // The border has on its left what it winds round, and so has the edge from a to b its face.
                const int winding = face->info().winding - (finite ? runs(a, b) : 0);
                next->info() = {winding > 0, true, winding};
                work.push_back(next);
            }
        }
    }

    using Corners = std::array<std::uint32_t, 3>;
    static constexpr int most_rounds = 100;

    static std::uint32_t name(FaceHandle face, int i) { return face->vertex(i)->info().point; }
    static Corners corners(FaceHandle face) { return {name(face, 0), name(face, 1), name(face, 2)}; }

    /// How much higher a triangle is than is_thick() asks for.
    static double thickness(const std::vector<Vec2>& at, const Corners& c)
    {
        return MeshingPlane::thickness(at[c[0]], at[c[1]], at[c[2]]);
    }

    static int longest_edge(const std::vector<Vec2>& at, FaceHandle face)
    {
        const auto length = [&](int i) {
            return glm::distance(at[name(face, Triangulation::ccw(i))], at[name(face, Triangulation::cw(i))]);
        };
        int longest = 0;
        for (const int i : {1, 2})
            if (length(i) > length(longest)) longest = i;
        return longest;
    }

    bool is_border(FaceHandle face, int i) const
    {
        return !face->neighbor(i)->info().inside ||
               on_border(face->vertex(Triangulation::ccw(i)), face->vertex(Triangulation::cw(i)));
    }

    /// Whether the other diagonal of a triangle and its neighbour leaves a thicker thinner half.
    bool flip_helps(const std::vector<Vec2>& at, FaceHandle face, int i) const
    {
        const FaceHandle other = face->neighbor(i);
        const std::uint32_t near = name(face, i), left = name(face, Triangulation::cw(i)),
                            right = name(face, Triangulation::ccw(i)), far = name(other, cdt_.mirror_index(face, i));
        return std::min(thickness(at, {near, right, far}), thickness(at, {near, far, left})) >
               std::min(thickness(at, corners(face)), thickness(at, corners(other)));
    }

    /// The first face, clockwise, of those round a vertex that hang together inside; any, but always the same, when
    /// they go all the way round.
    FaceHandle first_of_fan(VertexHandle v, FaceHandle face) const
    {
        const FaceHandle start = face;
        for (;;) {
            const int i = face->index(v);
            const FaceHandle before = face->neighbor(Triangulation::cw(i));
            if (!before->info().inside || on_border(v, face->vertex(Triangulation::ccw(i)))) return face;
            if (before == start) return v->face();
            face = before;
        }
    }

    LineArrangement lines_;
    Triangulation cdt_;
    std::map<Pair, int> border_;
    std::vector<SurfaceTriangulation::Line> line_edges_;  // between points
};

SurfaceTriangulation ArrangementTriangulation::extract(const MeshingPlane& plane, const std::vector<Vec3>& places) const
{
    SurfaceTriangulation result;
    std::vector<std::uint32_t> points;  // that the triangulation's vertices are
    // A vertex where the border touches itself has several fans of patches: each gets a vertex of its own, so that the
    // patches are a manifold. The copies of a point stay beside each other.
    std::map<std::pair<VertexHandle, FaceHandle>, std::uint32_t> index_of;
    std::map<Pair, std::array<std::uint32_t, 2>> edges;  // between points, to a triangle's vertices
    for (const FaceHandle face : cdt_.finite_face_handles()) {
        if (!face->info().inside) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (int k = 0; k < 3; ++k) {
            const VertexHandle v = face->vertex(k);
            const auto [entry, added] =
                index_of.try_emplace({v, first_of_fan(v, face)}, static_cast<std::uint32_t>(points.size()));
            if (added) points.push_back(v->info().point);
            triangle[static_cast<std::size_t>(k)] = entry->second;
        }
        result.triangles.push_back(triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
            edges[{points[a], points[b]}] = {a, b};
        }
    }
    for (const auto& line : line_edges_) {
        const auto forward = edges.find({line.vertices[0], line.vertices[1]});
        const bool inside = edges.contains({line.vertices[1], line.vertices[0]});
        if (forward != edges.end() && inside) result.lines.push_back({forward->second, line.kind});
    }
    for (const std::uint32_t point : points)
        result.positions.push_back(point < places.size() ? places[point] : plane.lift(lines_.points[point]));
    return result;
}

/// The border of a triangulation, which are the edges of one triangle, and its lines.
std::vector<PlanePiece> pieces_of(const SurfaceTriangulation& triangulation)
{
    std::set<Pair> edges;
    for (const auto& t : triangulation.triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.emplace(t[k], t[(k + 1) % 3]);
    std::vector<PlanePiece> pieces;
    for (const auto& [from, to] : edges)
        if (!edges.contains({to, from})) pieces.push_back({{from, to}, LineKind::contact, true, 0});
    for (const auto& line : triangulation.lines) pieces.push_back({line.vertices, line.kind, false, 0});
    return pieces;
}

/// Where the points are: old ones stay, those on the border lie on its edges, the rest in the plane.
std::vector<Vec3> places_of(const MeshingPlane& plane, const SurfaceTriangulation& old,
                            const std::vector<PlanePiece>& old_pieces, const LineArrangement& lines)
{
    std::vector<Vec3> places = old.positions;
    for (std::size_t i = places.size(); i < lines.points.size(); ++i) places.push_back(plane.lift(lines.points[i]));
    for (const PlanePiece& piece : lines.pieces) {
        if (!piece.border) continue;
        const auto& ends = old_pieces[piece.origin].points;
        const Vec2 &a = lines.points[ends[0]], &b = lines.points[ends[1]];
        const Vec3 &p = old.positions[ends[0]], &q = old.positions[ends[1]];
        for (const std::uint32_t point : piece.points)
            if (point >= old.positions.size())
                places[point] = p + glm::dot(lines.points[point] - a, b - a) / glm::dot(b - a, b - a) * (q - p);
    }
    return places;
}

SurfaceTriangulation with_lines(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                std::span<const SurfaceLine> lines, double merge)
{
    LineArrangement given;
    for (const Vec3& p : triangulation.positions) given.points.push_back(plane.to_plane(p));
    given.pieces = pieces_of(triangulation);
    const std::vector<PlanePiece> old_pieces = given.pieces;
    LineArrangement arranged = arrange_lines(std::move(given), lines, merge);
    const std::vector<Vec3> places = places_of(plane, triangulation, old_pieces, arranged);
    return ArrangementTriangulation(std::move(arranged)).extract(plane, places);
}

double area_of(const MeshingPlane& plane, const SurfaceTriangulation& triangulation)
{
    double twice = 0;
    for (const auto& t : triangulation.triangles) {
        const auto at = [&](std::size_t k) {
            return plane.frame.to_plane(triangulation.positions[t[k]]) / plane.diameter;
        };
        twice += cross2(at(0), at(1), at(2));
    }
    return 0.5 * twice;
}

/// No triangle without area, and together they have that of `before`: in a wedge of the border narrower than what is
/// merged its sides get into each other's way.
bool is_sound(const MeshingPlane& plane, const SurfaceTriangulation& triangulation, const SurfaceTriangulation& before)
{
    const double area = area_of(plane, before);
    return std::abs(area_of(plane, triangulation) - area) <= 1e-12 * area + 1e-15 &&
           std::ranges::all_of(triangulation.triangles, [&](const auto& t) {
               const auto at = [&](std::size_t k) {
                   return plane.frame.to_plane(triangulation.positions[t[k]]) / plane.diameter;
               };
               return MeshingPlane::is_thick(at(0), at(1), at(2));
           });
}

}  // namespace

SurfaceTriangulation triangulate_polygon(const Scene& scene, SurfaceId surface)
{
    const MeshingPlane plane{scene.surface(surface).frame, scene.diameter};
    LineArrangement outline;
    std::vector<Vec3> places;
    std::map<std::uint32_t, std::uint32_t> point_of;
    for (const auto& loop : scene.surface(surface).loops)
        for (const std::uint32_t vertex : loop)
            if (point_of.try_emplace(vertex, static_cast<std::uint32_t>(places.size())).second) {
                places.push_back(scene.vertices[vertex]);
                outline.points.push_back(plane.to_plane(places.back()));
            }
    for (const auto& loop : scene.surface(surface).loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            outline.pieces.push_back(
                {{point_of[loop[i]], point_of[loop[(i + 1) % loop.size()]]}, LineKind::contact, true, 0});
    ArrangementTriangulation triangulation(std::move(outline));
    triangulation.mend(plane, places);
    return triangulation.extract(plane, places);
}

SurfaceTriangulation insert_lines(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                  std::span<const SurfaceLine> lines, double merge)
{
    std::vector<SurfaceLine> scaled(lines.begin(), lines.end());
    for (SurfaceLine& line : scaled) {
        line.start /= plane.diameter;
        line.end /= plane.diameter;
    }
    // Lines that bend toward one another round after round can leave a triangle no thicker than rounding.
    for (int attempt = 0; attempt < 3; ++attempt, merge *= 8) {
        SurfaceTriangulation result = with_lines(plane, triangulation, scaled, merge);
        if (is_sound(plane, result, triangulation)) return result;
    }
    return triangulation;
}

}  // namespace patchlight
