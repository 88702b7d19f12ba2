#include "formfactor/pair_factor.h"
#include "formfactor/subdivided_exchange.h"

#include <algorithm>
#include <stdexcept>

namespace patchlight {

namespace {

constexpr double default_tolerance = 1e-4;
constexpr std::size_t most_nodes = 3U << 19;  // about a second of one thread

/// One order whichever way the pair is asked for: then both ways do the same arithmetic.
bool in_order(std::span<const Facet> first, std::span<const Facet> second)
{
    const auto less = [](const Vec3& p, const Vec3& q) {
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    return !std::ranges::lexicographical_compare(second, first, [&](const Facet& p, const Facet& q) {
        return std::ranges::lexicographical_compare(p.corners, q.corners, less);
    });
}

}  // namespace

PairFactor pair_by_quadrature(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                              std::span<const Facet> to, const PairOptions& options)
{
    const double area = total_area(from);
    if (!(area > 0 && total_area(to) > 0))
        throw std::invalid_argument("a form factor needs facets with an area on both sides");
    const bool straight = in_order(from, to);
    const Blockers blockers(scene);
    SubdividedExchange exchange(blockers, caster);
    exchange.start(options.seed, 0);
    for (const Facet& a : straight ? from : to)
        for (const Facet& b : straight ? to : from) exchange.add(a.corners, a.normal, b.corners, b.normal);
    // Relative to the smaller side, so that both ways stop at the same cell.
    OccludedOptions until;
    until.tolerance = (options.tolerance > 0 ? options.tolerance : default_tolerance) * std::min(area, total_area(to));
    until.max_nodes = most_nodes;
    const ExchangeEstimate sum = exchange.refine(until, true);
    return {sum.value / area, sum.error / area, sum.nodes};
}

}  // namespace patchlight
