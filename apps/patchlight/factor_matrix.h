#pragma once

#include "apps/patchlight/commands.h"
#include "apps/patchlight/scene_input.h"

namespace patchlight {

/// All form factors over the uniform mesh: computed, audited, repaired if asked, written to the files asked for, and
/// summed up on standard output. Throws LimitError before anything large is allocated, Interrupted, OutputError.
int report_matrix(const FormFactorsCommand& command, const SceneInput& input, Session& session);

}  // namespace patchlight
