#pragma once

#include "apps/run/stored_solution.h"

#include <string>

namespace patchlight {

/// A binary little-endian PLY of the patch mesh: x y z in the scene file's units, sRGB bytes red green blue of
/// B/π scaled so that the 98th percentile of what doesn't emit is at 0.8 of white, and float radiosity_r/g/b
/// in W/m²; faces carry the surface's number. A quadratic element becomes four triangles between its six nodes.
std::string encode_ply(const StoredSolution& solution);

/// One row a patch: patch, surface, material, centroid in the scene file's units, area in m², B in W/m², and
/// the error indicator in W/m²·m. B is the patch's mean: the light at nodes is in the other formats.
std::string encode_csv(const StoredSolution& solution);

/// What brings the 98th percentile of B/π at the vertices that don't emit to 0.8; 1 when nothing is lit.
double display_scale(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B);

}  // namespace patchlight
