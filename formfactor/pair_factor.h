#pragma once

#include "formfactor/facets.h"
#include "formfactor/form_factors.h"
#include "formfactor/ray_caster.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace patchlight {

/// How one pair is computed. Defaults stay below a second for two polygons on one thread.
struct PairOptions {
    FormFactorMethod method = FormFactorMethod::exact;
    int origins = 4096;          ///< hemicube: hemicubes over `from`, in 16 groups, 1 … 65536
    int resolution = 128;        ///< hemicube: pixels along an edge, even, 4 … 4096
    std::size_t rays = 1 << 22;  ///< hemisphere: in all, over all origins, 16 … 2^40
    double tolerance = 0;  ///< of F; 0 = the method's own: exact 1e-10 within about a second's work, closed-form 1e-12,
                           ///< quadrature 1e-4; given, exact goes on for 200 times that
    double relative_error = 0.005;  ///< monte-carlo: goes on until its standard error is below this part of F
    std::uint64_t seed = 1;
};

/// A form factor with what is known of its error.
struct PairFactor {
    double value = 0;
    /// Estimated absolute error: the standard error of sampling methods, a difference of two rules of the others; an
    /// indicator, no bound. Rounding (1e-15) is not in it.
    double error = 0;
    std::size_t samples = 0;  ///< rays, pixels, nodes or pairs of edges, as the method has it
};

/// The fraction of the power leaving `from` (evenly from all its facets' fronts) that reaches the fronts of `to`, by
/// the chosen method. All of the scene blocks but where light starts and ends, backs included; closed-form alone looks
/// through everything. Reciprocal to rounding for closed-form, exact and quadrature; exact only to the error it tells
/// where its work runs out.
/// Throws std::invalid_argument when either side is empty.
PairFactor pair_factor(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                       std::span<const Facet> to, const PairOptions& options);

/// The methods behind it, one a source file.
PairFactor pair_by_closed_form(std::span<const Facet> from, std::span<const Facet> to, const PairOptions& options);
/// The hemicube's error tells how much groups of origins differ, not what the pixels' raster makes wrong in all of
/// them: below 0.1 % where `to` covers 40 pixels, and falling with the resolution.
PairFactor pair_by_hemicube(const Scene& scene, std::span<const Facet> from, std::span<const Facet> to,
                            const PairOptions& options);
PairFactor pair_by_hemisphere(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                              std::span<const Facet> to, const PairOptions& options);
PairFactor pair_by_quadrature(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                              std::span<const Facet> to, const PairOptions& options);
PairFactor pair_by_exact(const Scene& scene, std::span<const Facet> from, std::span<const Facet> to,
                         const PairOptions& options);
PairFactor pair_by_monte_carlo(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                               std::span<const Facet> to, const PairOptions& options);

}  // namespace patchlight
