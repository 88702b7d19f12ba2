#pragma once

#include "formfactor/blockers.h"
#include "formfactor/form_factors.h"
#include "formfactor/ray_caster.h"
#include "formfactor/work_monitor.h"

namespace patchlight {

/// Fills F.backs where it matters: for rows whose sum misses 1 by more than `least`, what black backs receive. A patch
/// is cut along the contacts on it, the edges of blockers that lie in its plane; in each piece a few rays tell whether
/// it is open (no ray meets a back) or covered (all do, as under a standing block), and its area counts exactly; where
/// rays disagree, as beside an open sheet, the share of 1,024 rays is taken. Other rows keep 0.
/// Meant for closed scenes, where nothing else can be missing, but for patches that no lamp shines on and that look out
/// of what is closed, as the outside of a room with walls: what is left of their rows escapes (F.escaped). Throws
/// Interrupted.
void add_backs(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const Blockers& blockers,
               double least, std::uint64_t seed, FormFactorMatrix& F, const WorkMonitor& monitor);

}  // namespace patchlight
