#pragma once

#include "meshing/refinement.h"
#include "solver/gather.h"

namespace patchlight {

enum class Indicator {
    residual,          ///< B gathered anew at extra points of the patch against the linear solution there
    vertex_difference  ///< the lecture's: how much B differs between a patch's corners
};

struct EstimateOptions {
    Indicator indicator = Indicator::residual;
    int rays = 128;  ///< over the hemisphere at each point, 16 … 65536
};

/// Per patch, ≥ 0. It is an indicator, not a bound: it sees what the mesh can't follow, not what the rays missed.
struct ErrorEstimate {
    PatchField<double> eta;         ///< √∫|B̃ − B|² dA over the patch, W/m²·m, three bands together
    PatchField<std::uint8_t> edge;  ///< the edge, from corner k to k + 1, that is best halved
    double total = 0;               ///< √Σ η²
    double relative = 0;            ///< total / √∫|B − E|² dA over all reflecting surface; 0/0 = 0
};

/// √∫|B − E|² dA of the linear reconstruction over all reflecting surface, W/m²·m.
double reflected_norm(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& B);

/// What evaluating a solution finds: the error of its mesh, and the linear reconstruction it was found with.
struct Evaluation {
    ErrorEstimate error;
    VertexRadiosity vertex_B;  ///< gathered with the estimate's rays
    std::size_t rays = 0;
};

/// Residual: light is gathered at corners, edge midpoints and centroid of each patch with the same directions; what
/// differs there from linear interpolation is integrated with a rule of degree 3 (2/15 for each midpoint, 9/20 for
/// the centroid, times the area; the corners' error is 0). Vertex difference: |B_max − B_min| over the corners × √A.
/// Patches that reflect nothing have 0. The edge to halve is the one whose midpoint differs most (whose ends do): so
/// patches grow long along a shadow's edge and fine across it; the longest where none stands out. Throws Interrupted.
Evaluation evaluate(const Exchange& exchange, const Radiosity& B, const EstimateOptions& options,
                    const GatherOptions& gather, const WorkMonitor& monitor = {});

enum class Marking {
    doerfler,       ///< the fewest patches that hold a share of Σ η²
    fixed_fraction  ///< the worst share of the patches
};

struct MarkOptions {
    Marking marking = Marking::doerfler;
    double share = 0.5;   ///< of Σ η² (doerfler) or of the patches (fixed_fraction), in (0, 1]
    double least = 0.05;  ///< of the patches are split in any case: a few with huge errors must not cost a cycle each
    double smallest = 3e-6;  ///< edges below this × diameter are left alone
};

/// The patches to split next, the worst first: one bisection each. Small steps make good meshes. Edges no longer than
/// `smallest` stay. Touches nothing.
RefinementPlan mark(const Scene& scene, const PatchMesh& mesh, const ErrorEstimate& error, const MarkOptions& options);

}  // namespace patchlight
