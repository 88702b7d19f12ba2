#include "meshing/join_surfaces.h"

#include "meshing/plane_frame.h"
#include "meshing/trace_loops.h"
#include "meshing/union_find.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace patchlight {

namespace {

constexpr std::uint32_t black = PlaneTriangle::black;

enum class Side { front, back };

std::uint32_t shown(const PlaneTriangle& triangle, Side side)
{
    return side == Side::front ? triangle.front : triangle.back;
}

/// An edge of the arrangement and the triangle left of it.
struct HalfEdge {
    std::uint32_t low, high;
    std::uint32_t triangle;
    bool ascending;
};

/// The half-edges of all triangles, the two of an edge beside each other.
std::vector<HalfEdge> half_edges(const PlaneArrangement& arrangement)
{
    std::vector<HalfEdge> result;
    for (std::uint32_t t = 0; t < arrangement.triangles.size(); ++t) {
        const auto& v = arrangement.triangles[t].vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k], b = v[(k + 1) % 3];
            result.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    }
    std::sort(result.begin(), result.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return result;
}

/// Calls visit(h, other) for every half-edge with the one on the edge's other side, or nullptr.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& edges, Visit visit)
{
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto same = [&](std::size_t k) {
            return k < edges.size() && edges[k].low == edges[i].low && edges[k].high == edges[i].high;
        };
        const HalfEdge* other = i > 0 && same(i - 1) ? &edges[i - 1] : same(i + 1) ? &edges[i + 1] : nullptr;
        visit(edges[i], other);
    }
}

/// Twice the area within its border over the border's length: of a strip its width, of a sharp triangle half of that.
double mean_width(const Surface& surface, const std::vector<Vec3>& vertices)
{
    double twice_area = 0, length = 0;
    for (const auto& loop : surface.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2 a = surface.frame.to_plane(vertices[loop[k]]);
            const Vec2 b = surface.frame.to_plane(vertices[loop[(k + 1) % loop.size()]]);
            twice_area += cross2(Vec2(0.0), a, b);
            length += glm::distance(a, b);
        }
    return twice_area / length;
}

/// Joins one side of an arrangement.
class SideJoiner {
public:
    SideJoiner(const PlaneGroup& group, const PlaneArrangement& arrangement, const PolygonSoup& soup,
               SpaceRegions& regions, std::uint32_t first, Side side, bool join_objects)
        : group_(group), arrangement_(arrangement), soup_(soup), regions_(regions), first_(first), side_(side),
          join_objects_(join_objects)
    {}
    void join(const std::vector<HalfEdge>& edges, PlaneSurfaces& result);

private:
    MaterialId material(std::uint32_t triangle) const;
    bool belong_together(std::uint32_t triangle, std::uint32_t other);
    std::uint32_t shell(std::uint32_t triangle) { return regions_.shell(first_ + triangle, side_ == Side::front); }
    Surface make_surface(const std::vector<std::uint32_t>& triangles,
                         std::vector<std::pair<std::uint32_t, std::uint32_t>> border) const;

    const PlaneGroup& group_;
    const PlaneArrangement& arrangement_;
    const PolygonSoup& soup_;
    SpaceRegions& regions_;
    std::uint32_t first_;
    Side side_;
    bool join_objects_;
};

MaterialId SideJoiner::material(std::uint32_t triangle) const
{
    const std::uint32_t face = shown(arrangement_.triangles[triangle], side_);
    return face == black ? MaterialId{} : soup_.faces[face].material;
}

bool SideJoiner::belong_together(std::uint32_t triangle, std::uint32_t other)
{
    const std::uint32_t face = shown(arrangement_.triangles[triangle], side_);
    const std::uint32_t next = shown(arrangement_.triangles[other], side_);
    if (face == black || next == black) return false;
    const SoupFace &a = soup_.faces[face], &b = soup_.faces[next];
    return a.material == b.material && (join_objects_ || a.object == b.object) && shell(triangle) == shell(other);
}

Surface SideJoiner::make_surface(const std::vector<std::uint32_t>& triangles,
                                 std::vector<std::pair<std::uint32_t, std::uint32_t>> border) const
{
    Surface surface;
    surface.material = material(triangles[0]);
    surface.frame = side_ == Side::front ? group_.frame : turned_over(group_.frame);
    double largest = -1;
    for (const std::uint32_t t : triangles) {
        const PlaneTriangle& triangle = arrangement_.triangles[t];
        const auto& v = triangle.vertices;
        const Vec3& a = soup_.vertices[v[0]];
        surface.area += 0.5 * glm::length(glm::cross(soup_.vertices[v[1]] - a, soup_.vertices[v[2]] - a));
        const SoupFace& face = soup_.faces[shown(triangle, side_)];
        if (face.area > largest || (face.area == largest && face.object < surface.object)) {
            largest = face.area;
            surface.object = face.object;
        }
    }
    surface.loops = trace_loops(std::move(border), surface.frame, soup_.vertices, soup_.snap);
    surface.frame.origin = soup_.vertices[surface.loops[0][0]];
    return surface;
}

void SideJoiner::join(const std::vector<HalfEdge>& edges, PlaneSurfaces& result)
{
    const auto count = static_cast<std::uint32_t>(arrangement_.triangles.size());
    UnionFind components(count);
    for_each_edge(edges, [&](const HalfEdge& h, const HalfEdge* other) {
        if (other && belong_together(h.triangle, other->triangle)) components.join(h.triangle, other->triangle);
    });
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (material(t).valid()) members[components.root(t)].push_back(t);
    }
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> borders;
    for_each_edge(edges, [&](const HalfEdge& h, const HalfEdge* other) {
        if (!material(h.triangle).valid()) return;
        if (other && components.root(other->triangle) == components.root(h.triangle)) return;
        const bool forward = h.ascending == (side_ == Side::front);
        borders[components.root(h.triangle)].emplace_back(forward ? h.low : h.high, forward ? h.high : h.low);
    });
    for (const auto& [root, triangles] : members) {
        Surface surface = make_surface(triangles, std::move(borders[root]));
        // A chip that overlaps leave between edges all but in one place, perhaps upright in its plane: it only blocks.
        if (mean_width(surface, soup_.vertices) < soup_.snap) continue;
        const SurfaceId id(result.surfaces.size());
        result.surfaces.push_back(std::move(surface));
        for (const std::uint32_t t : triangles) {
            (side_ == Side::front ? result.triangles[t].front : result.triangles[t].back) = id;
        }
    }
}

}  // namespace

PlaneSurfaces join_surfaces(const PlaneGroup& group, const PlaneArrangement& arrangement, const PolygonSoup& soup,
                            SpaceRegions& regions, std::uint32_t first, bool join_objects)
{
    PlaneSurfaces result;
    for (const PlaneTriangle& triangle : arrangement.triangles) {
        SceneTriangle ours;
        ours.vertices = triangle.vertices;
        result.triangles.push_back(ours);
    }
    const std::vector<HalfEdge> edges = half_edges(arrangement);
    for (const Side side : {Side::front, Side::back})
        SideJoiner(group, arrangement, soup, regions, first, side, join_objects).join(edges, result);
    return result;
}

}  // namespace patchlight
