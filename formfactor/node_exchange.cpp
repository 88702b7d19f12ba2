#include "formfactor/node_exchange.h"

#include "formfactor/scrambled_points.h"
#include "formfactor/unoccluded_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace patchlight {

namespace {

/// More blockers near a pair than this: rays are quicker.
constexpr std::size_t few_blockers = 24;
/// So many are worth it where otherwise a thousand rays would be traced.
constexpr std::size_t more_blockers = 400;
/// Clipping errs by no more of the larger factor, as exact_rows.
constexpr double clipping_tolerance = 2e-5;

/// Nodes near each other for their size exchange most of their light between a few places, which points easily miss: so
/// much of the greatest kernel one more place may have. Measured on cities: 0 leaves 1.4 × the estimated error, with
/// no end of single outliers; 1/8 costs half as many links again for a tenth less error.
constexpr double missed_share = 1.0 / 16;

std::uint64_t key_of(std::uint32_t p, std::uint32_t q)
{
    return (static_cast<std::uint64_t>(p) << 32) | q;
}

double kernel_between(const Vec3& x, const Vec3& n, const Vec3& y, const Vec3& m)
{
    const Vec3 d = y - x;
    const double r2 = glm::dot(d, d);
    const double cosines = std::max(0.0, glm::dot(d, n)) * std::max(0.0, -glm::dot(d, m));
    return cosines > 0 ? cosines / (std::numbers::pi * r2 * r2) : 0;
}

double square(double x)
{
    return x * x;
}

double mean_of(std::span<const double> values)
{
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

/// Unbiased.
double variance_of(std::span<const double> values)
{
    const double mean = mean_of(values);
    double sum = 0;
    for (const double v : values) sum += (v - mean) * (v - mean);
    return sum / static_cast<double>(values.size() - 1);
}

/// The numbers from `first` to before `last` in random order: two nets whose points are paired as they come would meet
/// in the same few combinations of halves.
void shuffled_range(std::uint32_t first, std::uint32_t last, RandomNumbers& random, std::vector<std::uint32_t>& numbers)
{
    numbers.resize(last - first);
    for (std::uint32_t k = 0; k < numbers.size(); ++k) {
        const std::uint32_t other = random.below(k + 1);
        numbers[k] = numbers[other];
        numbers[other] = first + k;
    }
}

/// What n rays of which a share got through leave to expect, [Laplace1774]: never 0 or 1. What was expected before
/// weighs as much as two rays.
double expected_share(double share, double n, double before)
{
    return (n * share + 2 * before) / (n + 2);
}

double variance_of_share(double expected)
{
    return expected * (1 - expected);
}

}  // namespace

NodeExchange::NodeExchange(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                           const PatchHierarchy& tree, std::uint64_t seed)
    : scene_(scene), caster_(caster), mesh_(mesh), tree_(tree), blockers_(scene), seed_(seed)
{
    triangles_.reserve(tree.order.size());
    for (const PatchId patch : tree.order) {
        const auto c = mesh.corners(patch);
        const Vec3& origin = mesh.position(c[0]);
        triangles_.push_back({origin, mesh.position(c[1]) - origin, mesh.position(c[2]) - origin,
                              scene.surface(mesh.surface(patch)).frame.n});
    }
}

bool NodeExchange::may_face(std::uint32_t p, std::uint32_t q) const
{
    return patchlight::may_face(tree_.nodes[p], tree_.nodes[q], blockers_.snap());
}

NodeExchange::Point NodeExchange::point_on(std::uint32_t node, double along, double across) const
{
    const PatchHierarchy::Node& n = tree_.nodes[node];
    const auto begin = tree_.area_upto.begin();
    const double target = tree_.area_upto[n.first] + along * (tree_.area_upto[n.last] - tree_.area_upto[n.first]);
    const auto next = std::upper_bound(begin + n.first + 1, begin + n.last, target);
    const auto i = static_cast<std::size_t>(std::min<std::ptrdiff_t>(next - begin, n.last)) - 1;
    // What is left of the place along the order is as random as the place itself.
    const double rest =
        std::clamp((target - tree_.area_upto[i]) / (tree_.area_upto[i + 1] - tree_.area_upto[i]), 0x1p-20, 1 - 0x1p-20);
    const Triangle& triangle = triangles_[i];
    const double root = std::sqrt(rest), b1 = root * (1 - across), b2 = root * across;
    return {triangle.origin + b1 * triangle.u + b2 * triangle.v, triangle.normal};
}

/// `partial` too where a shaft isn't tried.
Visibility NodeExchange::seen_through(std::uint32_t p, std::uint32_t q, std::size_t most, Scratch& scratch) const
{
    const PatchHierarchy::Node &a = tree_.nodes[p], &b = tree_.nodes[q];
    if (!a.surface.valid() || !b.surface.valid()) return Visibility::partial;
    node_hull(scene_, mesh_, tree_, p, scratch.hull_p);
    node_hull(scene_, mesh_, tree_, q, scratch.hull_q);
    return blockers_.among_few(scratch.hull_p, a.axis, scratch.hull_q, b.axis, most, scratch.between);
}

/// m points on each of both, and the kernel between every two of them with nothing in between.
void NodeExchange::set_points(std::uint32_t p, std::uint32_t q, std::uint32_t m, std::uint32_t draw,
                              Scratch& scratch) const
{
    const std::uint64_t key = RandomNumbers(key_of(p, q), draw).bits();
    const ScrambledPoints points_p(seed_, key), points_q(seed_, key + 1);
    scratch.on_p.resize(m);
    scratch.on_q.resize(m);
    for (std::uint32_t k = 0; k < m; ++k) {
        const auto [u, v] = points_p(k);
        const auto [s, t] = points_q(k);
        scratch.on_p[k] = point_on(p, u, v);
        scratch.on_q[k] = point_on(q, s, t);
    }
    scratch.kernel.clear();
    for (const Point& x : scratch.on_p)
        for (const Point& y : scratch.on_q)
            scratch.kernel.push_back(kernel_between(x.place, x.normal, y.place, y.normal));
}

/// Strikes out what is hidden.
void NodeExchange::trace_points(Scratch& scratch) const
{
    scratch.rays.resize(scratch.kernel.size());
    std::size_t k = 0;
    for (const Point& x : scratch.on_p)
        for (const Point& y : scratch.on_q) {
            const Vec3 start = caster_.leave(x.place, x.normal);
            scratch.rays.set(k++, start, caster_.leave(y.place, y.normal) - start, 1.0F);
        }
    caster_.occluded(scratch.rays, scratch.blocked);
    for (std::size_t i = 0; i < scratch.kernel.size(); ++i)
        if (scratch.blocked[i] != 0) scratch.kernel[i] = 0;
    scratch.traced += scratch.kernel.size();
}

MeanKernel NodeExchange::between_points(std::uint32_t p, std::uint32_t q, std::uint32_t m, std::uint32_t draw,
                                        double expected, Scratch& scratch) const
{
    // For two rays each way a shaft costs more than it saves.
    const Visibility seen = m > 2 ? seen_through(p, q, few_blockers, scratch) : Visibility::partial;
    if (seen == Visibility::hidden) return {};
    set_points(p, q, m, draw, scratch);
    const auto n = static_cast<double>(scratch.kernel.size());
    const auto open = static_cast<double>(std::ranges::count_if(scratch.kernel, [](double k) { return k > 0; }));
    // The kernel where there is one: what a place has that no pair of points chanced to see.
    const double typical =
        open > 0 ? mean_of(scratch.kernel) * n / open : greatest_kernel(tree_.nodes[p], tree_.nodes[q]);
    MeanKernel result;
    if (seen != Visibility::visible && open > 0) {
        trace_points(scratch);
        result.rays = static_cast<std::uint32_t>(scratch.kernel.size());
    }
    const auto free = static_cast<double>(std::ranges::count_if(scratch.kernel, [](double k) { return k > 0; }));
    const bool sure = seen == Visibility::visible && free == n;
    result.open = expected_share(free / n, n, expected);
    const double unsure = sure ? 0 : square(typical) * variance_of_share(result.open);
    result.mean = mean_of(scratch.kernel);
    scratch.row.assign(m, 0.0);
    scratch.column.assign(m, 0.0);
    for (std::size_t k = 0; k < scratch.kernel.size(); ++k) {
        scratch.row[k / m] += scratch.kernel[k] / m;
        scratch.column[k % m] += scratch.kernel[k] / m;
    }
    const double over_p = variance_of(scratch.row), over_q = variance_of(scratch.column);
    const double chance = (over_p + over_q) / m;
    const double missed = square(missed_share * greatest_kernel(tree_.nodes[p], tree_.nodes[q])) / (m + 2);
    const auto spread = [&](std::uint32_t node, double variance) {
        return std::sqrt(tree_.nodes[node].is_leaf() ? std::max(chance, unsure / n)
                                                     : std::max({variance, unsure, missed}));
    };
    result.spread_p = spread(p, over_p);
    result.spread_q = spread(q, over_q);
    return result;
}

/// Rays between two patches so far: what was open of the kernel along them.
struct NodeExchange::Share {
    double expected = 0.5, all = 0, squares = 0, free = 0;
    std::uint32_t rays = 0;

    /// Rays of uneven weight count for fewer.
    double count() const { return squares > 0 ? all * all / squares : 1; }
    double value() const { return all > 0 ? free / all : 0; }
    double open() const { return expected_share(value(), count(), expected); }
    double error() const { return std::sqrt(variance_of_share(open()) / count()); }
};

/// Traces more until there are as many as wanted.
void NodeExchange::add_rays(std::uint32_t p, std::uint32_t q, std::uint32_t wanted, Share& share,
                            Scratch& scratch) const
{
    const std::uint64_t key = key_of(p, q);
    const ScrambledPoints points_p(seed_, 2 * key), points_q(seed_, 2 * key + 1);
    RandomNumbers random(seed_ + share.rays, key);
    scratch.rays.resize(wanted - share.rays);
    scratch.kernel.resize(scratch.rays.size());
    shuffled_range(share.rays, wanted, random, scratch.partner);
    for (std::uint32_t k = 0; k < scratch.rays.size(); ++k) {
        const auto [u, v] = points_p(share.rays + k);
        const auto [s, t] = points_q(scratch.partner[k]);
        const Point x = point_on(p, u, v), y = point_on(q, s, t);
        const Vec3 start = caster_.leave(x.place, x.normal);
        scratch.kernel[k] = kernel_between(x.place, x.normal, y.place, y.normal);
        scratch.rays.set(k, start, caster_.leave(y.place, y.normal) - start, 1.0F);
    }
    caster_.occluded(scratch.rays, scratch.blocked);
    for (std::size_t k = 0; k < scratch.rays.size(); ++k) {
        share.all += scratch.kernel[k];
        share.squares += scratch.kernel[k] * scratch.kernel[k];
        if (scratch.blocked[k] == 0) share.free += scratch.kernel[k];
    }
    share.rays = wanted;
}

MeanKernel NodeExchange::between_patches(std::uint32_t p, std::uint32_t q, double spread, double expected,
                                         Scratch& scratch) const
{
    Visibility seen = seen_through(p, q, few_blockers, scratch);
    if (seen == Visibility::hidden) return {};
    const PatchHierarchy::Node &a = tree_.nodes[p], &b = tree_.nodes[q];
    const double areas = a.area * b.area;
    Polygon front_p, front_q;
    keep_front(scratch.hull_p, b.axis, glm::dot(b.axis, scratch.hull_q[0]), blockers_.snap(), front_p);
    keep_front(scratch.hull_q, a.axis, glm::dot(a.axis, scratch.hull_p[0]), blockers_.snap(), front_q);
    if (front_p.size() < 3 || front_q.size() < 3) return {};
    const double open = unoccluded_exchange(front_p, a.axis, front_q, b.axis) / areas;
    if (seen == Visibility::visible || !(open > 0)) return {.mean = open, .best = true};
    Share share{.expected = expected};
    const auto sampled = [&](bool best) {
        const double error = open * share.error();
        return MeanKernel{open * share.value(), error, error, share.open(), share.rays, best};
    };
    for (const std::uint32_t wanted : {16U, 64U}) {
        add_rays(p, q, wanted, share, scratch);
        if (open * share.error() <= spread) return sampled(false);
    }
    if (scratch.between.empty()) seen = seen_through(p, q, more_blockers, scratch);
    if (seen == Visibility::hidden) return {};
    if (seen == Visibility::visible) return {.mean = open, .rays = share.rays, .best = true};
    if (scratch.between.empty()) {
        for (const std::uint32_t wanted : {256U, 1024U}) {
            add_rays(p, q, wanted, share, scratch);
            if (open * share.error() <= spread) return sampled(wanted == 1024U);
        }
        return sampled(true);
    }
    scratch.in_shaft.resize(scratch.between.size());
    std::iota(scratch.in_shaft.begin(), scratch.in_shaft.end(), 0U);
    const double allowed = std::max(0.5 * spread * areas, clipping_tolerance * std::min(a.area, b.area));
    const double clipped = partial_exchange(front_p, a.axis, front_q, b.axis, scratch.between, scratch.in_shaft,
                                            blockers_.snap(), open * areas, allowed, scratch.partial);
    return {clipped / areas, allowed / areas, allowed / areas, share.open(), share.rays, true};
}

}  // namespace patchlight
