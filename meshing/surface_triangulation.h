#pragma once

#include "meshing/patch_locator.h"
#include "meshing/scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace patchlight {

/// The patches of one surface, with indices of their own: what meshing works on, surface by surface.
struct SurfaceTriangulation {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front
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
    Vec2 to_plane(const Vec3& p) const { return rounded(frame.to_plane(p) / diameter); }
    Vec3 lift(const Vec2& q) const { return frame.lift(q * diameter); }
};

/// The constrained Delaunay triangulation of a surface's polygon by CGAL, no vertex added.
SurfaceTriangulation triangulate_polygon(const Scene& scene, SurfaceId surface);

/// The patches of one surface of a mesh.
SurfaceTriangulation triangulation_of(const PatchMesh& mesh, SurfaceId surface);

/// How long an edge may be at a point of the surface's frame (m); infinity = as it is.
using TargetEdge = std::function<double(const Vec2& q)>;

/// Delaunay refinement: inserts circumcentres (or middles of border edges that lie in the way) until no patch has a
/// longer edge than the target at its centroid, and, where the input's own angles permit, no angle below `min_angle`
/// (degrees, 0 … 20.7). Old vertices stay; nothing to do = nothing changed. Expects a constrained Delaunay
/// triangulation. Always the same result: CGAL's own mesher orders equal triangles by their address, so that it
/// meshes a symmetric polygon differently from run to run. [Ruppert95], [Chew93].
SurfaceTriangulation refine_triangulation(const MeshingPlane& plane, const SurfaceTriangulation& triangulation,
                                          const TargetEdge& target, double min_angle);

}  // namespace patchlight
