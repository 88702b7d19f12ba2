#pragma once

#include "formfactor/form_factors.h"
#include "formfactor/ray_caster.h"
#include "formfactor/work_monitor.h"
#include "meshing/patch_locator.h"

#include <span>

namespace patchlight {

/// The whole matrix by options.method: hemisphere by RowSampler with the given `sources` (surfaces that may be seen by
/// Lambert's formula; none: rays alone), hemicube by hemicube_rows, quadrature by quadrature_rows, exact by exact_rows,
/// closed-form by exact_rows with nothing in between. Throws std::invalid_argument for monte-carlo, which is for pairs,
/// and Interrupted.
FormFactorMatrix form_factor_matrix(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                    const PatchLocator& locator, const FormFactorOptions& options,
                                    const WorkMonitor& monitor, std::span<const SurfaceId> sources = {});

/// Bytes that form_factor_matrix will take at its peak, from the number of patches alone: an upper estimate, rows of
/// exact, quadrature and closed-form taken as five sixths full (a convex room's).
double matrix_bytes(FormFactorMethod method, std::size_t patches, const FormFactorOptions& options);

}  // namespace patchlight
