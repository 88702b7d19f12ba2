#include "formfactor/blockers.h"
#include "formfactor/occluded_exchange.h"
#include "formfactor/pair_factor.h"
#include "formfactor/polygon_factor.h"

#include <algorithm>

namespace patchlight {

namespace {

constexpr double default_tolerance = 1e-10;

/// What an answer may cost by default, in blockers looked at from nodes: about a second.
constexpr std::size_t default_work = 2'000'000;
/// With a tolerance asked for.
constexpr std::size_t patient_work = 200 * default_work;
/// While more stand in between, cutting the polygons costs less than looking at all of them from every node.
constexpr std::size_t many_blockers = 20;
constexpr std::size_t fewest_nodes = 20, least_work = 2500;

/// Looking past n blockers leaves the polygon in pieces that each of the later ones is held against.
std::size_t work_of_a_node(std::size_t blockers)
{
    return blockers + blockers * blockers / 8;
}

/// A polygon with the unit normal of its plane.
struct Side {
    Polygon corners;
    Vec3 normal;
};

/// Sums A_1 F_12 over pairs of facets within a share of the work each.
class ExactSum {
public:
    ExactSum(const Blockers& blockers, double tolerance) : blockers_(blockers), tolerance_(tolerance) {}

    void add(const Facet& a, const Facet& b, std::size_t work)
    {
        std::vector<Blocker> between;
        const Visibility visibility = blockers_.between(a.corners, a.normal, b.corners, b.normal, between);
        if (visibility == Visibility::hidden) return;
        if (visibility == Visibility::visible) {
            sum.value += polygon_exchange(a.corners, b.corners, 1e-13);
            ++sum.nodes;
            return;
        }
        Side first{{}, a.normal}, second{{}, b.normal};
        keep_front(a.corners, b.normal, glm::dot(b.normal, b.corners[0]), blockers_.snap(), first.corners);
        keep_front(b.corners, a.normal, glm::dot(a.normal, a.corners[0]), blockers_.snap(), second.corners);
        add_part(first, second, between, work, tolerance_);
    }

    ExchangeEstimate sum;
    std::size_t spent = 0;

private:
    /// Integrates, or first cuts the longer of both polygons in halves while many blockers stand in between.
    void add_part(const Side& a, const Side& b, const std::vector<Blocker>& between, std::size_t work, double tolerance)
    {
        if (between.size() <= many_blockers || work < least_work) {
            const std::size_t nodes = std::max(fewest_nodes, work / work_of_a_node(between.size()));
            const ExchangeEstimate part =
                occluded_exchange(a.corners, a.normal, b.corners, b.normal, between, blockers_.snap(),
                                  {.tolerance = tolerance, .max_nodes = std::min<std::size_t>(nodes, 1U << 21)});
            sum.value += part.value;
            sum.error += part.error;
            sum.nodes += part.nodes;
            spent += part.nodes * work_of_a_node(between.size());
            return;
        }
        const Vec3 extent_a = longest_extent(a.corners), extent_b = longest_extent(b.corners);
        const bool cut_a = glm::dot(extent_a, extent_a) > glm::dot(extent_b, extent_b);
        for (const double side : {1.0, -1.0}) {
            Side half{{}, cut_a ? a.normal : b.normal};
            keep_half(cut_a ? a.corners : b.corners, side * (cut_a ? extent_a : extent_b), half.corners);
            if (half.corners.size() >= 3)
                add_half(cut_a ? half : a, cut_a ? b : half, between, work / 2, tolerance / 2);
        }
    }

    void add_half(const Side& a, const Side& b, const std::vector<Blocker>& between, std::size_t work, double tolerance)
    {
        std::vector<std::uint32_t> found;
        const Visibility visibility = sift({a.corners, b.corners}, between, blockers_.snap(), found);
        spent += between.size();
        if (visibility == Visibility::hidden) return;
        if (visibility == Visibility::visible) {
            sum.value += fragment_exchange(a.corners, a.normal, b.corners, b.normal, 1e-13);
            ++sum.nodes;
            return;
        }
        std::vector<Blocker> rest;
        for (const std::uint32_t k : found) rest.push_back(between[k]);
        add_part(a, b, rest, work, tolerance);
    }

    const Blockers& blockers_;
    double tolerance_;
};

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
    std::size_t pairs = from.size() * to.size(), left = options.tolerance > 0 ? patient_work : default_work;
    ExactSum exact(blockers, tolerance * std::min(area, total_area(to)) / static_cast<double>(pairs));
    for (const Facet& a : from)
        for (const Facet& b : to) {
            const std::size_t before = exact.spent;
            exact.add(a, b, left / pairs--);
            left -= std::min(left, exact.spent - before);
        }
    return {exact.sum.value / area, exact.sum.error / area, exact.sum.nodes};
}

}  // namespace patchlight
