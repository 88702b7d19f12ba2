#pragma once

#include "meshing/patch_locator.h"
#include "meshing/patch_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace patchlight {

/// How surfaces are cut into patches.
struct MeshingOptions {
    double max_edge = 0;    ///< longest edge of the uniform mesh, m; 0 = a twelfth of the scene's diameter
    double min_angle = 20;  ///< degrees, 0 … 20.7; angles between the input's own edges are exempt
    std::size_t max_elements =
        0;  ///< budget of triangles, 0 = none; refine() never returns more than it, or than it got
};

/// What marking asks of refinement: plain data. Empty = nothing left to do.
struct RefinementPlan {
    struct Bisection {
        PatchId patch;
        std::uint8_t edge = 0;  ///< from corner k to corner k + 1
    };
    std::vector<SurfaceLine> lines;     ///< to become edges, the most wanted first
    std::vector<Bisection> bisections;  ///< edges to halve, the most wanted first

    bool empty() const { return lines.empty() && bisections.empty(); }
};

/// For each new patch the old patches that it covers. Delaunay refinement isn't nested: a new patch may lie
/// over several old ones.
struct PatchTransfer {
    struct Overlap {
        PatchId old_patch;
        double area = 0;  ///< m² common to both
    };
    std::vector<std::uint32_t> start;  ///< new_patches + 1: where the overlaps of each new patch begin
    std::vector<Overlap> overlaps;     ///< they sum to the new patch's area, over an old patch to the old one's
};

struct Refinement {
    PatchMesh mesh;
    PatchTransfer transfer;
};

/// The uniform mesh: per surface a constrained Delaunay triangulation of its polygon, refined by Delaunay
/// meshing until no edge is longer than `max_edge` and no angle smaller than `min_angle`. With `max_elements`
/// and no max_edge: the longest edge that gives between 0.8 N and N triangles (as near below N as the input's
/// own edges permit). A surface narrower than a sixtieth of the longest edge has no angle
/// bound. Surfaces are meshed independently, on all threads; the result does not depend on their number. With lines,
/// these are edges of the mesh, and surfaces that hold some have no angle bound.
PatchMesh triangulate(const Scene& scene, const MeshingOptions& options, std::span<const SurfaceLine> lines = {});

/// Does what the plan asks for, surface by surface; all stays constrained Delaunay, and no angle is bounded. Old
/// vertices stay, but for surfaces that get their first lines: these are meshed anew, of their outline and the lines
/// alone; where there are new lines, nothing is bisected yet. An empty plan gives the same mesh. When the budget
/// doesn't reach, only the first lines and bisections are honoured.
PatchMesh refined(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const MeshingOptions& options);

/// The same, with what carries values per patch over.
Refinement refine(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const MeshingOptions& options);

/// Which old patches each new one covers, by clipping them against each other in their surface's plane.
PatchTransfer overlap(const PatchMesh& old_mesh, const PatchLocator& old_locator, const PatchMesh& new_mesh);

/// Carries a value per patch to the new mesh, weighted by common area: Σ A_i x_i is conserved.
PatchField<Rgb> prolong(const PatchMesh& new_mesh, const PatchField<Rgb>& values, const PatchTransfer& transfer);

}  // namespace patchlight
