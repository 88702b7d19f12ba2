#pragma once

#include "meshing/patch_locator.h"
#include "meshing/scene.h"
#include "meshing/surface_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

/// The patches of one surface, with indices of their own: what meshing works on, surface by surface.
struct SurfaceTriangulation {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front

    /// An edge between two triangles that lies on a line, and stays an edge whatever else changes.
    struct Line {
        std::array<std::uint32_t, 2> vertices{};
        LineKind kind = LineKind::contact;
    };
    std::vector<Line> lines;
};

/// Meshing's own plane coordinates: those of the surface's frame over the scene's diameter, rounded to multiples of
/// 2⁻³⁰ (a tenth of the snap of 1e-8): the same polygon gives the same triangles whatever its scale and place.
struct MeshingPlane {
    const PlaneFrame& frame;
    double diameter;

    static Vec2 rounded(const Vec2& q)
    {
        return {std::ldexp(std::round(std::ldexp(q.x, 30)), -30), std::ldexp(std::round(std::ldexp(q.y, 30)), -30)};
    }
    /// The least height of a triangle, less several times the rounding of its corners; negative also when it is
    /// clockwise.
    static double thickness(const Vec2& a, const Vec2& b, const Vec2& c)
    {
        return cross2(a, b, c) / std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}) - 4e-9;
    }
    static bool is_thick(const Vec2& a, const Vec2& b, const Vec2& c) { return thickness(a, b, c) > 0; }
    Vec2 to_plane(const Vec3& p) const { return rounded(frame.to_plane(p) / diameter); }
    Vec3 lift(const Vec2& q) const { return frame.lift(q * diameter); }
};

/// The constrained Delaunay triangulation of a surface's polygon by CGAL, no vertex added.
SurfaceTriangulation triangulate_polygon(const Scene& scene, SurfaceId surface);

/// Puts lines into a triangulation of a surface: each becomes a chain of its edges. Lines that cross get a vertex
/// there; what is nearer to a vertex, to another line or to the border than `merge` (of the scene's diameter) goes
/// through it or joins it; what lies on the border or outside the surface is dropped. Old vertices and lines stay, all
/// else becomes constrained Delaunay again. Where lines coincide the lowest kind remains. Should a triangle be left
/// without area, more is merged; should that not help either, there are no lines.
SurfaceTriangulation insert_lines(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                  std::span<const SurfaceLine> lines, double merge = 2e-6);

/// The patches of one surface of a mesh, its contact lines sewn up.
SurfaceTriangulation triangulation_of(const PatchMesh& mesh, SurfaceId surface);

/// Cuts contact lines open: every vertex on them gets a copy for each side, at their ends inside the surface, too,
/// where the cut goes on along one more edge, the straightest. `twin_lines` are the copies' names of the same edges.
struct CutTriangulation {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<MeshLine> lines;
};
CutTriangulation cut_contacts(const PlaneFrame& frame, const SurfaceTriangulation& triangulation);

/// How long an edge may be at a point of the surface's frame (m); infinity = as it is.
using TargetEdge = std::function<double(const Vec2& q)>;

/// Delaunay refinement: inserts circumcentres (or middles of border edges and lines that lie in the way) until no patch
/// has a longer edge than the target at its centroid, and, where the input's own angles permit, no angle below
/// `min_angle` (degrees, 0 … 20.7; with lines only 0). Old vertices stay; nothing to do = nothing changed. Expects a
/// constrained Delaunay triangulation. Always the same result: CGAL's own mesher orders equal triangles by their
/// address, so that it meshes a symmetric polygon differently from run to run. [Ruppert95], [Chew93].
SurfaceTriangulation refine_triangulation(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                          const TargetEdge& target, double min_angle);

/// Puts a vertex into the middle of each of the edges, in their order, and makes the triangulation constrained Delaunay
/// again after each. An edge that flips took away meanwhile still gets its vertex, where its middle is now; one whose
/// halves would leave a triangle without area stays whole. No angle is bounded: a patch becomes as long and narrow as
/// the choice of edges makes it.
SurfaceTriangulation bisect_edges(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                  std::span<const std::array<std::uint32_t, 2>> edges);

}  // namespace patchlight
