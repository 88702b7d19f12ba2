#pragma once

#include "apps/patchlight/commands.h"
#include "apps/patchlight/scene_input.h"

namespace patchlight {

/// A solve of which everything is known that tells its run from others.
struct PlannedSolve {
    SolveCommand command;  ///< with the other run's mesh, and what the camera sees
    View view;             ///< of the pictures; without them none
    RunIdentity identity;
};

/// Reads what the command names besides its scene. The scene's views get the run's own in front. Throws UsageError,
/// FolderRefused, SceneError.
PlannedSolve plan_solve(const SolveCommand& command, SceneInput& input, const RayCaster& caster);

/// The rest of `solve`: into the folder command.run, from the beginning or its last whole cycle; prints what it came
/// to. Returns the exit code. Throws LimitError before anything is written.
int solve_planned(const PlannedSolve& plan, const SceneInput& input, const RayCaster& caster, Session& session);

}  // namespace patchlight
