#pragma once

#include "solver/adaptive_options.h"
#include "solver/kept_rows.h"
#include "solver/progress.h"
#include "solver/stages.h"

#include <array>
#include <functional>
#include <optional>
#include <stop_token>

namespace patchlight {

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
/// requested; the steps already observed are whole. Throws InvariantError where an answer can't be right.
AdaptiveSolution solve_adaptively(const Scene& scene, const AdaptiveOptions& options,
                                  const AdaptiveObservers& observers = {},
                                  std::optional<AdaptiveStart> start = std::nullopt);

}  // namespace patchlight
