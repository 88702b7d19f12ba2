#pragma once

#include "formfactor/blockers.h"
#include "formfactor/form_factors.h"
#include "formfactor/work_monitor.h"

namespace patchlight {

/// All rows by quadrature, pair by pair (SubdividedExchange): for meshes of up to about 2,000 patches, the time grows
/// with their square. A_i F_ij = A_j F_ji to rounding. A pair of unoccluded exchange U is done when its estimated error
/// is below t·√(U·min(A_i, A_j)), t = options.tolerance (0 = 1e-3): errors of a row are independent, so that
/// together they are below t·√(Σ U/A_i), relative to the row's sum near t. `backs` as in add_backs, where more than 1 %
/// of a row in a closed scene is missing; in an open one what is missing counts as `escaped`. Columns ascend.
/// On all threads, the same on any number of them. Throws Interrupted.
FormFactorMatrix quadrature_rows(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                 const FormFactorOptions& options, const WorkMonitor& monitor);

}  // namespace patchlight
