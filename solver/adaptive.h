#pragma once

#include "formfactor/form_factors.h"
#include "meshing/refinement.h"
#include "solver/discontinuities.h"
#include "solver/estimate.h"
#include "solver/indirect_light.h"
#include "solver/kept_rows.h"
#include "solver/progress.h"
#include "solver/radiosity.h"
#include "solver/solve.h"

#include <array>
#include <functional>
#include <optional>
#include <stop_token>

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

/// Wall seconds of one cycle, for timing.json only.
struct StageSeconds {
    double mesh = 0, assemble = 0, solve = 0, gather = 0, estimate = 0;
};

enum class Stage { uniform, rough, adaptive, final };

/// One record a cycle, to the observer. References live until the observer returns.
struct AdaptiveStep {
    int cycle = 0;
    Stage stage = Stage::rough;
    const PatchMesh& mesh;
    const Radiosity& B;               ///< per patch: solved on the uniform mesh, else the means of the linear solution
    const VertexRadiosity& vertex_B;  ///< the linear reconstruction
    const MidpointRadiosity& middle_B;  ///< of quadratic elements, in the last cycle; empty: linear elements
    const SolveReport& solved;
    const ErrorEstimate& error;
    const EnergyBalance& energy;
    std::size_t splits = 0;                            ///< how many edges the plan halves next, and lines it inserts
    std::array<LineCount, line_kinds.size()> lines{};  ///< by kind
    std::size_t rays = 0;                              ///< traced in this cycle
    const StageSeconds& seconds;
};
using StepObserver = std::function<void(const AdaptiveStep&)>;

/// A finished cycle of an interrupted run, to go on from.
struct AdaptiveStart {
    int cycle = 0;
    PatchMesh mesh;
    Radiosity B;
    ErrorEstimate error;
};

/// Who is told, and who may stop it; and who keeps what was traced.
struct AdaptiveObservers {
    StepObserver on_step;
    ProgressObserver on_progress;
    std::stop_token stop;
    /// With Refine::none: rows that it holds are used instead of being traced, and must be those of the same geometry,
    /// mesh and options; the others are filled in before on_step. Rays count the same either way.
    KeptRows* rows = nullptr;
};

struct AdaptiveSolution {
    PatchMesh mesh;
    Radiosity B;
    VertexRadiosity vertex_B;
    MidpointRadiosity middle_B;  ///< empty: linear elements
    ErrorEstimate error;
    EnergyBalance energy;
    SolveReport solved;
    bool converged = false;  ///< the linear solve met its tolerance, and target_error, if asked for, was met
};

/// THE loop: uniform mesh → rough radiosity of its patches → indirect light on a mesh of its own → evaluation →
/// adaptive mesh → … → final radiosity. Each mesh is lit by the emitters' light, found anew at its nodes, and the
/// indirect light, which is solved once. Refine::none: the uniform mesh alone, its light gathered from its patches. The
/// answer depends on scene and options only, not on the number of threads. Throws Interrupted when observers.stop is
/// requested; the steps already observed are whole.
AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers = {},
                                  std::optional<AdaptiveStart> start = std::nullopt);

}  // namespace patchlight
