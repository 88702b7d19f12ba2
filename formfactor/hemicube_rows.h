#pragma once

#include "formfactor/form_factors.h"
#include "formfactor/work_monitor.h"

namespace patchlight {

/// All rows by the lecture's hemicube [CohenGreenberg85]: one in front of each patch's centroid (`departure`) with
/// options.resolution pixels along an edge, turned at random by the seed and the patch, onto which all patches are
/// projected. The scene gives the surfaces' planes, and what blocks without being a patch. F_ij is the factor of the
/// centroid alone: too coarse where j is nearer than about five times i's size, and blind to what is smaller than a
/// pixel. Rows with `escaped` and `backs` sum to 1 + 0.54/resolution². On all threads, the same on any number of them.
/// Throws std::invalid_argument as Hemicube does for the resolution, and Interrupted.
FormFactorMatrix hemicube_rows(const Scene& scene, const PatchMesh& mesh, const FormFactorOptions& options,
                               const WorkMonitor& monitor);

}  // namespace patchlight
