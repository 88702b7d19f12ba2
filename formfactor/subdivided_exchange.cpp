#include "formfactor/subdivided_exchange.h"

#include "formfactor/facet_points.h"
#include "formfactor/polygon_factor.h"
#include "formfactor/random_numbers.h"
#include "formfactor/scrambled_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace patchlight {

namespace {

constexpr std::size_t nodes = 16;         // of a pair of polygons
constexpr std::size_t most_cuts = 64;     // at once: enough work for all threads
constexpr double exact_tolerance = 1e-9;  // of an unoccluded exchange, relative to its smaller polygon

/// Of corners that clipping put closer than `snap` together one stays: rounding decides which way their edge runs.
void merge_corners(Polygon& polygon, double snap)
{
    Polygon kept;
    for (const Vec3& p : polygon) {
        const bool apart = kept.empty() || (glm::length(p - kept.back()) > snap && glm::length(p - kept[0]) > snap);
        if (apart) kept.push_back(p);
    }
    polygon = kept;
}

/// What is thinner than coordinates are told apart is no polygon any more: rounding decides its shape.
bool has_area(const Polygon& polygon, double snap)
{
    if (polygon.size() < 3) return false;
    const Vec3 d = longest_extent(polygon);
    return 2 * glm::length(area_vector(polygon)) > std::max(snap, 1e-9 * glm::length(d)) * glm::length(d);
}

std::array<std::uint8_t, nodes> shuffled(RandomNumbers& random)
{
    std::array<std::uint8_t, nodes> order{};
    for (std::size_t k = 0; k < nodes; ++k) order[k] = static_cast<std::uint8_t>(k);
    for (std::size_t k = nodes; k > 1; --k) std::swap(order[k - 1], order[random.below(static_cast<std::uint32_t>(k))]);
    return order;
}

}  // namespace

struct SubdividedExchange::Scratch {
    RayBatch rays;
    std::vector<std::uint8_t> blocked;
    std::vector<std::uint32_t> found;
    std::array<double, nodes> weights{};
};

void SubdividedExchange::start(std::uint64_t seed, std::uint64_t key)
{
    roots_.clear();
    cells_.clear();
    seed_ = seed;
    key_ = key;
    visible_ = 0;
    exact_ = 0;
}

double SubdividedExchange::add(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b,
                               const Vec3& normal_b)
{
    const Visibility visibility = blockers_.between(a, normal_a, b, normal_b, found_);
    if (visibility == Visibility::hidden) return 0;
    if (visibility == Visibility::visible) {
        const double exchange = polygon_exchange(a, b, exact_tolerance);
        visible_ += exchange;
        ++exact_;
        return exchange;
    }
    Cell cell;
    keep_front(a, normal_b, glm::dot(normal_b, b[0]), blockers_.snap(), cell.a);
    keep_front(b, normal_a, glm::dot(normal_a, a[0]), blockers_.snap(), cell.b);
    merge_corners(cell.a, blockers_.snap());
    merge_corners(cell.b, blockers_.snap());
    if (!has_area(cell.a, blockers_.snap()) || !has_area(cell.b, blockers_.snap())) return 0;
    cell.blockers = std::make_shared<const std::vector<Blocker>>(std::move(found_));
    cell.root = roots_.size();
    cell.key = RandomNumbers(key_, cell.root).bits();
    cell.unoccluded = polygon_exchange(cell.a, cell.b, exact_tolerance);
    roots_.push_back({normal_a, normal_b});
    cells_.push_back(std::move(cell));
    return cells_.back().unoccluded;
}

/// One half of a cell, with what is seen of it.
void SubdividedExchange::cut(const Cell& parent, bool upper, Cell& child, Scratch& scratch) const
{
    const Vec3 extent_a = longest_extent(parent.a), extent_b = longest_extent(parent.b);
    child.value = child.error = child.unoccluded = 0;
    child.root = parent.root;
    child.key = RandomNumbers(parent.key, upper ? 1 : 0).bits();
    if (glm::dot(extent_a, extent_a) >= glm::dot(extent_b, extent_b)) {
        keep_half(parent.a, upper ? extent_a : -extent_a, child.a);
        merge_corners(child.a, blockers_.snap());
        child.b = parent.b;
    } else {
        keep_half(parent.b, upper ? extent_b : -extent_b, child.b);
        merge_corners(child.b, blockers_.snap());
        child.a = parent.a;
    }
    if (!has_area(child.a, blockers_.snap()) || !has_area(child.b, blockers_.snap())) return;
    const Visibility visibility = sift({child.a, child.b}, *parent.blockers, blockers_.snap(), scratch.found);
    if (visibility == Visibility::hidden) return;
    child.unoccluded = polygon_exchange(child.a, child.b, exact_tolerance);
    child.value = child.unoccluded;
    if (visibility == Visibility::visible) return;
    child.blockers = parent.blockers;
    if (scratch.found.size() < parent.blockers->size()) {
        std::vector<Blocker> rest;
        rest.reserve(scratch.found.size());
        for (const std::uint32_t k : scratch.found) rest.push_back((*parent.blockers)[k]);
        child.blockers = std::make_shared<const std::vector<Blocker>>(std::move(rest));
    }
    sample(child, scratch);
}

/// The visible share of a cell by rays between its nodes. With n of them (fewer when the kernel's weights differ) and
/// a share s its variance is taken for p(1 − p)/n, p = (ns + 1)/(n + 2): not 0 when all agree [Laplace1774].
void SubdividedExchange::sample(Cell& cell, Scratch& scratch) const
{
    const Root& root = roots_[cell.root];
    const FacetPoints on_a{std::span<const Vec3>(cell.a)}, on_b{std::span<const Vec3>(cell.b)};
    const ScrambledPoints points_a(seed_, cell.key), points_b(seed_, cell.key + 1);
    RandomNumbers random(seed_, cell.key + 2);
    const auto order = shuffled(random);
    scratch.rays.resize(nodes);
    for (std::uint32_t k = 0; k < nodes; ++k) {
        const auto [u, v] = points_a(k);
        const auto [s, t] = points_b(order[k]);
        const Vec3 x = on_a.at(u, v).position, y = on_b.at(s, t).position, d = y - x;
        const double r2 = glm::dot(d, d);
        scratch.weights[k] =
            std::max(0.0, glm::dot(d, root.normal_a)) * std::max(0.0, -glm::dot(d, root.normal_b)) / (r2 * r2);
        const Vec3 start = caster_.leave(x, root.normal_a), end = caster_.leave(y, root.normal_b);
        scratch.rays.set(k, start, end - start, 1.0F);
    }
    caster_.occluded(scratch.rays, scratch.blocked);
    double all = 0, squares = 0, seen = 0;
    for (std::size_t k = 0; k < nodes; ++k) {
        const double weight = scratch.weights[k];
        all += weight;
        squares += weight * weight;
        if (scratch.blocked[k] == 0) seen += weight;
    }
    const double n = squares > 0 ? all * all / squares : 0, share = all > 0 ? seen / all : 0.5;
    const double p = (n * share + 1) / (n + 2);
    cell.value = share * cell.unoccluded;
    cell.error = cell.unoccluded * std::sqrt(p * (1 - p) / std::max(1.0, n));
}

template <class Work>
void SubdividedExchange::for_each(std::size_t n, bool parallel, const Work& work)
{
    const auto range = [&](std::size_t first, std::size_t last) {
        Scratch scratch;
        for (std::size_t k = first; k < last; ++k) work(k, scratch);
    };
    if (!parallel) return range(0, n);
    constexpr std::size_t block = 8;
    tbb::parallel_for(std::size_t{0}, (n + block - 1) / block,
                      [&](std::size_t b) { range(b * block, std::min(n, (b + 1) * block)); });
}

ExchangeEstimate SubdividedExchange::refine(const OccludedOptions& options, bool parallel)
{
    const auto less = [](const Cell& p, const Cell& q) {
        return p.error != q.error ? p.error < q.error : p.key < q.key;
    };
    for_each(cells_.size(), parallel, [&](std::size_t k, Scratch& scratch) { sample(cells_[k], scratch); });
    std::ranges::make_heap(cells_, less);
    ExchangeEstimate sum{0, 0, exact_ + nodes * cells_.size()};
    double squares = 0;
    for (const Cell& cell : cells_) squares += cell.error * cell.error;
    std::vector<Cell> parents, children;
    while (!cells_.empty() && squares > options.tolerance * options.tolerance && sum.nodes < options.max_nodes) {
        // Few cells: few at a time, or the worst would wait for others that need no cut.
        parents.clear();
        const std::size_t cuts = std::clamp<std::size_t>(cells_.size() / 8, 1, most_cuts);
        for (std::size_t k = 0; k < cuts; ++k) {
            std::ranges::pop_heap(cells_, less);
            parents.push_back(std::move(cells_.back()));
            cells_.pop_back();
        }
        children.assign(2 * cuts, {});
        for_each(children.size(), parallel,
                 [&](std::size_t k, Scratch& scratch) { cut(parents[k / 2], k % 2 != 0, children[k], scratch); });
        for (const Cell& parent : parents) squares -= parent.error * parent.error;
        for (Cell& child : children) {
            if (child.error == 0) {
                visible_ += child.value;
                ++sum.nodes;
                continue;
            }
            squares += child.error * child.error;
            sum.nodes += nodes;
            cells_.push_back(std::move(child));
            std::ranges::push_heap(cells_, less);
        }
    }
    squares = 0;  // afresh: differences left their rounding
    sum.value = visible_;
    for (const Cell& cell : cells_) {
        sum.value += cell.value;
        squares += cell.error * cell.error;
    }
    sum.error = std::sqrt(squares);
    return sum;
}

}  // namespace patchlight
