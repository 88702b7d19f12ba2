#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/cost_estimate.h"
#include "formfactor/ray_caster.h"

namespace patchlight {

/// The rows that --mesh's run keeps, where they hold for this solve; none otherwise, and why is said: as a note where
/// they are of something else, as a warning where the file is broken. Throws LimitError before more is read than
/// --memory allows.
KeptRows factors_of_run(const SolveCommand& command, const Scene& scene, const RayCaster& caster,
                        const Session& session);

/// What --keep-factors will write beside what the solve needs, told; throws LimitError where memory or disk haven't
/// room for that.
void check_factors_fit(const SolveCommand& command, const CostEstimate& cost, const Session& session);

}  // namespace patchlight
