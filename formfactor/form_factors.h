#pragma once

#include "formfactor/ray_caster.h"
#include "meshing/patch_locator.h"
#include "meshing/patch_mesh.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// How form factors are found.
enum class FormFactorMethod {
    closed_form,  ///< contour integrals of polygon pairs; what stands in between is not seen
    hemicube,     ///< item buffers on half cubes over the patch
    hemisphere,   ///< rays over the hemisphere from places all over the patch
    quadrature,   ///< pairs cut until visible, hidden or small; a visibility ray for each pair of nodes in those
    exact,        ///< Lambert's formula on what clipping against the blockers leaves, integrated over the patch
    monte_carlo   ///< random pairs of points and random rays, with a standard error
};

/// The set of directions over the hemisphere.
enum class HemisphereDirections {
    stratified,  ///< cosine-weighted points of a scrambled net: ΔF = 1/n each
    regular_grid,  ///< the lecture's: Δφ = Δθ = 2π/k, ring m at its middle, weighed exactly by sin² of its borders / k
    lecture_grid  ///< the same directions with the lecture's ΔF = (2π/k²) sin 2θ, which sums to Δθ·cot Δθ
};

struct FormFactorOptions {
    FormFactorMethod method = FormFactorMethod::hemisphere;
    HemisphereDirections directions = HemisphereDirections::stratified;
    int rays = 512;        ///< per patch, 16 … 65536; rounded up to what the directions allow
    int shadow_rays = 16;  ///< per patch, shared among small sources by their factors (16 each at least), 4 … 4096
    double small_source =
        0.2;               ///< sources with a smaller unoccluded factor are seen by Lambert's formula; 0 = none are
    int resolution = 256;  ///< hemicube: pixels along an edge, even, 4 … 4096
    double tolerance = 0;  ///< quadrature: relative, of a row; exact: of a pair's larger factor; 0 = the method's own
    std::uint64_t seed = 1;
};

/// Fractions F_ij of the power leaving patch i that reach patches j, in order of first hit.
struct FormFactorRow {
    std::vector<PatchId> patches;
    std::vector<double> factors;
    double raw_sum = 0;  ///< before small sources were seen by Lambert's formula
    double escaped = 0;  ///< fraction that meets no surface
    double backs = 0;    ///< fraction that meets a black back
};

/// Rows of F, compressed. Reciprocal for quadrature and exact; sampled rows only gather.
struct FormFactorMatrix {
    std::vector<std::size_t> row_start;  ///< patches + 1
    std::vector<std::uint32_t> columns;  ///< of each row, in order of first hit, or ascending
    std::vector<double> factors;
    PatchField<double> raw_sum, escaped, backs;
    std::size_t rays = 0;  ///< or pixels, or nodes

    std::size_t size() const { return row_start.empty() ? 0 : row_start.size() - 1; }
};

class RowSampler;
struct WorkMonitor;

/// All rows, on all threads. Throws Interrupted.
FormFactorMatrix assemble_rows(const RowSampler& sampler, std::size_t patches, const WorkMonitor& monitor);

}  // namespace patchlight
