#pragma once

#include "solver/adaptive_options.h"
#include "solver/stages.h"

#include <span>

namespace patchlight {

/// The mesh that is given, or the uniform one to begin with. An automatic one leaves three quarters of the budget to
/// refinement.
PatchMesh first_mesh(const Scene& scene, const AdaptiveOptions& options);

/// Whether the lines where light breaks off become edges.
bool uses_lines(const AdaptiveOptions& options);

/// What to change next, by mark() and worthwhile_lines() as far as options.refine asks for them: `error` is that of the
/// mesh, `counted` the same as far as it counts for what is looked at (Lighting::counted()).
RefinementPlan plan_next(const Scene& scene, const PatchMesh& mesh, const Radiosity& B, const ErrorEstimate& error,
                         const ErrorEstimate& counted, std::span<const Discontinuity> lines,
                         const AdaptiveOptions& options);

/// Whether `mesh`, that of this cycle, is the last: the target is met, the budget used, or nothing left to change.
bool finished(const PatchMesh& mesh, const ErrorEstimate& error, const RefinementPlan& plan, int cycle,
              const AdaptiveOptions& options);

/// The mesh that the plan asks for: refined() within the budget; Refine::discontinuity: a uniform one with the plan's
/// lines. Stage "mesh"; throws Interrupted.
PatchMesh next_mesh(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan,
                    const AdaptiveOptions& options, Stages& stages);

}  // namespace patchlight
