#include "formfactor/form_factor_matrix.h"

#include "formfactor/exact_rows.h"
#include "formfactor/hemicube_rows.h"
#include "formfactor/quadrature_rows.h"
#include "formfactor/row_sampler.h"

#include <algorithm>
#include <stdexcept>

namespace patchlight {

FormFactorMatrix form_factor_matrix(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                    const PatchLocator& locator, const FormFactorOptions& options,
                                    const WorkMonitor& monitor, std::span<const SurfaceId> sources)
{
    switch (options.method) {
    case FormFactorMethod::hemisphere: {
        const RowSampler sampler(scene, caster, mesh, locator, sources, options);
        return assemble_rows(sampler, mesh.patch_count(), monitor);
    }
    case FormFactorMethod::hemicube:
        return hemicube_rows(scene, mesh, options, monitor);
    case FormFactorMethod::quadrature:
        return quadrature_rows(scene, caster, mesh, options, monitor);
    case FormFactorMethod::exact:
        return exact_rows(scene, caster, mesh, options, monitor);
    case FormFactorMethod::closed_form:
        return exact_rows(scene, caster, mesh, options, monitor, false);
    case FormFactorMethod::monte_carlo:
        break;
    }
    throw std::invalid_argument("monte-carlo is for pairs, not for whole matrices");
}

double matrix_bytes(FormFactorMethod method, std::size_t patches, const FormFactorOptions& options)
{
    constexpr double entry = 12, patch = 4000;  // a column and a factor; mesh, trees, nodes and vectors of rows
    const auto n = static_cast<double>(patches);
    double row = n;  // most entries
    if (method == FormFactorMethod::hemisphere) row = std::min(n, static_cast<double>(options.rays));
    if (method == FormFactorMethod::hemicube)
        row = std::min(n, 3.0 * static_cast<double>(options.resolution) * options.resolution);
    const bool halves = method == FormFactorMethod::exact || method == FormFactorMethod::quadrature ||
                        method == FormFactorMethod::closed_form;
    // Half rows, grown by doubling, beside the whole ones; sampled rows beside their copies.
    return n * (halves ? row * entry * 2 * 5 / 6 : row * entry * 2) + n * patch;
}

}  // namespace patchlight
