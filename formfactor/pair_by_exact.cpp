#include "formfactor/blockers.h"
#include "formfactor/occluded_exchange.h"
#include "formfactor/pair_factor.h"
#include "formfactor/polygon_factor.h"

#include <algorithm>

namespace patchlight {

namespace {

constexpr double default_tolerance = 1e-10;

/// A_1 F_12 of two facets; adds to the estimate.
void add_facets(const Blockers& blockers, const Facet& a, const Facet& b, const OccludedOptions& options,
                std::vector<Blocker>& between, ExchangeEstimate& sum)
{
    const Visibility visibility = blockers.between(a.corners, a.normal, b.corners, b.normal, between);
    if (visibility == Visibility::hidden) return;
    if (visibility == Visibility::visible) {
        sum.value += polygon_exchange(a.corners, b.corners, 1e-13);
        ++sum.nodes;
        return;
    }
    Polygon front_a, front_b;
    keep_front(a.corners, b.normal, glm::dot(b.normal, b.corners[0]), blockers.snap(), front_a);
    keep_front(b.corners, a.normal, glm::dot(a.normal, a.corners[0]), blockers.snap(), front_b);
    const ExchangeEstimate part =
        occluded_exchange(front_a, a.normal, front_b, b.normal, between, blockers.snap(), options);
    sum.value += part.value;
    sum.error += part.error;
    sum.nodes += part.nodes;
}

}  // namespace

PairFactor pair_by_closed_form(std::span<const Facet> from, std::span<const Facet> to, const PairOptions& options)
{
    const double tolerance = std::clamp(options.tolerance > 0 ? options.tolerance : 1e-12, 1e-14, 1e-2);
    PairFactor factor;
    double exchange = 0;
    for (const Facet& a : from)
        for (const Facet& b : to) {
            exchange += polygon_exchange(a.corners, b.corners, tolerance);
            factor.samples += a.corners.size() * b.corners.size();
        }
    factor.value = exchange / total_area(from);
    factor.error = tolerance * std::min(1.0, total_area(to) / total_area(from));
    return factor;
}

PairFactor pair_by_exact(const Scene& scene, std::span<const Facet> from, std::span<const Facet> to,
                         const PairOptions& options)
{
    const Blockers blockers(scene);
    const double area = total_area(from);
    const double tolerance = options.tolerance > 0 ? options.tolerance : default_tolerance;
    OccludedOptions each;
    each.tolerance = tolerance * std::min(area, total_area(to)) / static_cast<double>(from.size() * to.size());
    ExchangeEstimate sum;
    std::vector<Blocker> between;
    for (const Facet& a : from)
        for (const Facet& b : to) add_facets(blockers, a, b, each, between, sum);
    return {sum.value / area, sum.error / area, sum.nodes};
}

}  // namespace patchlight
