#pragma once

#include "meshing/refinement.h"
#include "solver/gather.h"

namespace patchlight {

enum class Indicator {
    residual,          ///< B found anew at extra points of the patch against the linear solution there
    middles,           ///< the same at the middles of edges alone
    vertex_difference  ///< the lecture's: how much B differs between a patch's corners
};

struct EstimateOptions {
    Indicator indicator = Indicator::residual;
    int rays = 128;  ///< over the hemisphere at each point, where the estimate gathers light itself, 16 … 65536
};

/// An estimate, not a bound.
struct ErrorEstimate {
    PatchField<double> eta;  ///< what the mesh can't follow: √∫|B̃ − B|² dA over the patch, W/m²·m, all bands
    PatchField<std::uint8_t> edge;  ///< the edge, from corner k to k + 1, that is best halved
    double total = 0;               ///< √(Σ η² + (the indirect light's own error)²), W/m²·m
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

/// Residual: light is asked for at corners, edge midpoints and centroid of each patch; what differs there from linear
/// interpolation is integrated with a rule of degree 3 (2/15 for each midpoint, 9/20 for the centroid, times the area;
/// the corners' error is 0). Middles: the quadratic function through them is integrated. Vertex difference: |B_max −
/// B_min| over the corners × √A. Patches that reflect nothing have 0. The edge to halve is the one whose midpoint
/// differs most (whose ends do): so patches grow long along a shadow's edge and fine across it; the longest where none
/// stands out. Where light comes twice, by other rays, η² is the product of both differences, which noise leaves right
/// in the mean. `indirect`: the error of the indirect light that `light` holds, √∫|B̃ − B|² dA in W/m²·m. Throws
/// Interrupted.
Evaluation evaluate(const Exchange& exchange, const LightAtPoints& light, Indicator indicator, double crease_angle,
                    double indirect = 0, const WorkMonitor& monitor = {});

enum class Marking {
    doerfler,       ///< the fewest patches that hold a share of Σ η²
    fixed_fraction  ///< the worst share of the patches
};

struct MarkOptions {
    Marking marking = Marking::doerfler;
    double share = 0.5;   ///< of Σ η² (doerfler) or of the patches (fixed_fraction), in (0, 1]
    double least = 0.05;  ///< of the patches are split in any case: a few with huge errors must not cost a cycle each
    double smallest = 3e-6;  ///< edges below this × diameter are left alone
    /// Of what counts as error, the part that is relative to the patch's own light instead of the whole scene's, in
    /// [0, 1]: dark places by the feet of things matter to the eye, and to the square over all surfaces not at all.
    double local = 0.05;
};

/// The patches to split next, the worst first: one bisection each. Small steps make good meshes. Edges no longer than
/// `smallest` stay. A patch's η² counts 1 − local + local · b²/(|B − E|² + (0.03 b)²) times, b the root mean square of
/// |B − E| over all that reflects; B per patch, W/m². Touches nothing.
RefinementPlan mark(const Scene& scene, const PatchMesh& mesh, const Radiosity& B, const ErrorEstimate& error,
                    const MarkOptions& options);

}  // namespace patchlight
