#include "formfactor/pair_factor.h"

#include <stdexcept>

namespace patchlight {

PairFactor pair_factor(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                       std::span<const Facet> to, const PairOptions& options)
{
    if (from.empty() || to.empty()) throw std::invalid_argument("a form factor needs surfaces on both sides");
    switch (options.method) {
    case FormFactorMethod::closed_form:
        return pair_by_closed_form(from, to, options);
    case FormFactorMethod::hemicube:
        return pair_by_hemicube(scene, from, to, options);
    case FormFactorMethod::hemisphere:
        return pair_by_hemisphere(scene, caster, from, to, options);
    case FormFactorMethod::quadrature:
        return pair_by_quadrature(scene, caster, from, to, options);
    case FormFactorMethod::exact:
        return pair_by_exact(scene, from, to, options);
    case FormFactorMethod::monte_carlo:
        return pair_by_monte_carlo(scene, caster, from, to, options);
    }
    throw std::invalid_argument("unknown form-factor method");
}

}  // namespace patchlight
