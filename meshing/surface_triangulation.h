#pragma once

#include "meshing/patch_locator.h"
#include "meshing/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// The patches of one surface, with indices of their own: what meshing works on, surface by surface.
struct SurfaceTriangulation {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the front
};

/// Delaunay meshing of a surface's polygon by CGAL: no edge longer than `max_edge` (m; ≤ 0: no bound) and, except
/// at the input's own angles, no angle below `min_angle` (degrees, ≤ 20.7, where it is sure to end). A surface
/// narrower than a sixtieth of `max_edge` has no angle bound: it would cost as many triangles as it is longer than wide.
SurfaceTriangulation triangulate_surface(const Scene& scene, SurfaceId surface, double max_edge, double min_angle);

/// Delaunay refinement: inserts circumcentres (or middles of border edges that lie in the way) until no patch has a
/// longer edge than `target_edge` asks where it lies (one value per patch of `mesh`, m), and, where the input's own
/// angles permit, no angle below `min_angle` (degrees). Old vertices stay; nothing to do = nothing changed.
/// [Chew93], [Ruppert95].
SurfaceTriangulation refine_surface(const Scene& scene, SurfaceId surface, const PatchMesh& mesh,
                                    const PatchLocator& locator, std::span<const double> target_edge, double min_angle);

}  // namespace patchlight
