#pragma once

#include "formfactor/blockers.h"
#include "formfactor/form_factors.h"
#include "formfactor/work_monitor.h"

namespace patchlight {

/// Fills F.backs where it matters: for rows whose sum misses 1 by more than `least`, the exact factors to the black
/// backs of the scene's surfaces (a patch under a standing block sees nothing else), to 1e-5. Other rows keep 0.
/// Meant for closed scenes, where nothing else can be missing. Throws Interrupted.
void add_backs(const Scene& scene, const PatchMesh& mesh, const Blockers& blockers, double least, FormFactorMatrix& F,
               const WorkMonitor& monitor);

}  // namespace patchlight
