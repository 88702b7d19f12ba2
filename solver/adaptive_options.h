#pragma once

#include "formfactor/form_factors.h"
#include "meshing/refinement.h"
#include "solver/discontinuities.h"
#include "solver/emitted_light.h"
#include "solver/estimate.h"
#include "solver/gather.h"
#include "solver/radiosity.h"
#include "solver/solve.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace patchlight {

/// What changes the uniform mesh.
enum class Refine {
    none,
    intensity,      ///< edges are halved where the light asks for it
    discontinuity,  ///< the lines where the light breaks off, otherwise uniform
    both            ///< lines first, then intensity
};

/// Everything solve_adaptively needs to know.
struct AdaptiveOptions {
    MeshingOptions meshing;  ///< of the first, uniform mesh (with Refine::none: the only one)
    /// Solved on instead of the uniform mesh, with Refine::none: methods compared on one mesh.
    std::optional<PatchMeshArrays> mesh;
    FormFactorOptions form_factors;
    SolveOptions final{.solver = Solver::gauss_seidel, .tolerance = 1e-4};  ///< of the patches of the uniform mesh
    GatherOptions gather{.rays = 0};  ///< no rays: as many as the error asks for; on a uniform mesh 512
    EstimateOptions estimate;
    MarkOptions mark;
    LineOptions lines;
    Refine refine = Refine::both;
    Elements elements = Elements::linear;  ///< of the last mesh's solution; errors are estimated for linear ones
    Direct direct = Direct::exact;         ///< too many emitters (emitters_light()): by the rays of indirect light
    int iterations = 40;                   ///< refinements at most, ≥ 1
    double target_error = 0;               ///< stop when the estimated error is below; 0 = go on to the budget
    std::size_t max_elements = 8000;       ///< budget of patches
    /// What is looked at: points that count alike. Refinement is weighted by how much light there depends on a patch;
    /// the estimated error stays that of the whole scene. None: everything counts alike.
    std::vector<SurfacePoint> looked_at;
};

}  // namespace patchlight
