#include "formfactor/facet_points.h"
#include "formfactor/pair_factor.h"
#include "formfactor/random_numbers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

namespace {

constexpr std::size_t batch_size = 4096;                       // pairs of a ray and a pair of points
constexpr std::size_t first_batches = 16;                      // 2^16 pairs at least: the normal law holds by then
constexpr std::size_t zero_batches = (1U << 22) / batch_size;  // nothing seen in so many: there is nothing
constexpr std::size_t most_batches = (1U << 28) / batch_size;

/// Both sides, and what is sampled on them.
struct Sides {
    const Scene& scene;
    const RayCaster& caster;
    std::span<const Facet> from, to;
    FacetPoints from_points, to_points;
    std::vector<std::uint8_t> is_target;  ///< per surface
};

/// Sums over the pairs of a batch.
struct Moments {
    double sum = 0, squares = 0;
    std::size_t pairs = 0;

    void add(const Moments& more)
    {
        sum += more.sum;
        squares += more.squares;
        pairs += more.pairs;
    }
    double mean() const { return sum / static_cast<double>(pairs); }
    double standard_error() const
    {
        const double n = static_cast<double>(pairs), m = mean();
        return std::sqrt(std::max(0.0, squares / n - m * m) / (n - 1));
    }
};

/// Working memory of a batch.
struct BatchScratch {
    RayBatch rays;
    HitBatch hits;
    std::vector<std::uint8_t> blocked;
    std::vector<FacetPoint> starts;
    std::vector<Vec3> directions;
    std::vector<double> weights;
    std::vector<std::size_t> pair_of;
    std::vector<double> values;  ///< of each pair
};

/// The balance heuristic's weight times the integrand over the density, of either way to make the pair of points
/// d apart [VeachGuibas95]: K/(K + 1/A), K = cos cos/(π r²), A the area of `to`. In [0, 1), 0 behind either front.
double balanced_weight(const Vec3& d, const Vec3& n_from, const Vec3& n_to, double area)
{
    const double near = glm::dot(d, n_from), far = -glm::dot(d, n_to), r2 = glm::dot(d, d);
    if (!(near > 0 && far > 0)) return 0;
    const double K = area * near * far / (std::numbers::pi * r2 * r2);
    return K / (K + 1);
}

Vec3 cosine_direction(const PlaneFrame& frame, RandomNumbers& random)
{
    const double u = random.uniform(), phi = 2 * std::numbers::pi * random.uniform(), sine = std::sqrt(u);
    return sine * std::cos(phi) * frame.u + sine * std::sin(phi) * frame.v + std::sqrt(1 - u) * frame.n;
}

/// Rays from points of `from`, by the cosine: those that meet `to` first count.
void add_rays(const Sides& sides, RandomNumbers& random, BatchScratch& scratch)
{
    scratch.rays.resize(batch_size);
    scratch.starts.resize(batch_size);
    scratch.directions.resize(batch_size);
    for (std::size_t i = 0; i < batch_size; ++i) {
        const double u = random.uniform(), v = random.uniform();
        const FacetPoint start = scratch.starts[i] = sides.from_points.at(u, v);
        const PlaneFrame& frame = sides.scene.surface(sides.from[start.facet].surface).frame;
        scratch.directions[i] = cosine_direction(frame, random);
        scratch.rays.set(i, sides.caster.leave(start.position, frame.n), scratch.directions[i],
                         std::numeric_limits<float>::infinity());
    }
    sides.caster.closest(scratch.rays, scratch.hits);
    for (std::size_t i = 0; i < batch_size; ++i) {
        const std::uint32_t hit = scratch.hits.surface[i];
        if (hit >= sides.is_target.size() || sides.is_target[hit] == 0) continue;
        const PlaneFrame& frame = sides.scene.surfaces[hit].frame;
        const Vec3& d = scratch.directions[i];
        const FacetPoint& start = scratch.starts[i];
        const double reach = glm::dot(frame.n, frame.origin - start.position) / glm::dot(frame.n, d);
        scratch.values[i] +=
            balanced_weight(reach * d, sides.from[start.facet].normal, frame.n, sides.to_points.area());
    }
}

/// Pairs of points, uniform over both areas: those that see each other count.
void add_point_pairs(const Sides& sides, RandomNumbers& random, BatchScratch& scratch)
{
    scratch.rays.resize(batch_size);
    scratch.weights.clear();
    scratch.pair_of.clear();
    for (std::size_t i = 0; i < batch_size; ++i) {
        const double u = random.uniform(), v = random.uniform(), s = random.uniform(), t = random.uniform();
        const FacetPoint x = sides.from_points.at(u, v), y = sides.to_points.at(s, t);
        const Vec3 &n_from = sides.from[x.facet].normal, &n_to = sides.to[y.facet].normal;
        const double weight = balanced_weight(y.position - x.position, n_from, n_to, sides.to_points.area());
        if (!(weight > 0)) continue;
        // Both ends stand off their surfaces: neither hides the other, however near they are.
        const Vec3 start = sides.caster.leave(x.position, n_from), end = sides.caster.leave(y.position, n_to);
        scratch.rays.set(scratch.weights.size(), start, end - start, 1.0F);
        scratch.weights.push_back(weight);
        scratch.pair_of.push_back(i);
    }
    scratch.rays.resize(scratch.weights.size());
    sides.caster.occluded(scratch.rays, scratch.blocked);
    for (std::size_t k = 0; k < scratch.weights.size(); ++k)
        if (scratch.blocked[k] == 0) scratch.values[scratch.pair_of[k]] += scratch.weights[k];
}

Moments batch(const Sides& sides, std::uint64_t seed, std::uint64_t key)
{
    BatchScratch scratch;
    RandomNumbers random(seed, key);
    scratch.values.assign(batch_size, 0.0);
    add_rays(sides, random, scratch);
    add_point_pairs(sides, random, scratch);
    Moments moments;
    moments.pairs = batch_size;
    for (const double value : scratch.values) {
        moments.sum += value;
        moments.squares += value * value;
    }
    return moments;
}

/// Whether a part of each facet is in front of the other for any pair: else nothing is exchanged, whatever stands
/// between.
bool may_face(const Sides& sides)
{
    const auto in_front = [&](const Facet& of, const Facet& other) {
        const double least = 1e-12 * sides.scene.diameter;
        return std::ranges::any_of(other.corners,
                                   [&](const Vec3& p) { return glm::dot(of.normal, p - of.corners[0]) > least; });
    };
    return std::ranges::any_of(sides.from, [&](const Facet& a) {
        return std::ranges::any_of(sides.to, [&](const Facet& b) { return in_front(a, b) && in_front(b, a); });
    });
}

bool finished(const Moments& all, double relative_error)
{
    const std::size_t batches = all.pairs / batch_size;
    if (all.sum == 0) return batches >= zero_batches;
    return batches >= most_batches || all.standard_error() <= relative_error * all.mean();
}

}  // namespace

PairFactor pair_by_monte_carlo(const Scene& scene, const RayCaster& caster, std::span<const Facet> from,
                               std::span<const Facet> to, const PairOptions& options)
{
    Sides sides{scene, caster, from, to, FacetPoints(from), FacetPoints(to), {}};
    sides.is_target.assign(scene.surfaces.size(), 0);
    for (const Facet& facet : to) sides.is_target[facet.surface.value] = 1;
    if (!may_face(sides)) return {};
    Moments all;
    std::vector<Moments> round(first_batches);
    do {
        const std::size_t done = all.pairs / batch_size;
        // Rounds of half of what is done: at most so much is traced in vain.
        round.resize(std::clamp<std::size_t>(done / 2, first_batches, std::max(most_batches - done, first_batches)));
        tbb::parallel_for(std::size_t{0}, round.size(),
                          [&](std::size_t b) { round[b] = batch(sides, options.seed, done + b); });
        for (const Moments& moments : round) all.add(moments);
    } while (!finished(all, options.relative_error));
    // Not one of n rays: the factor is below 3/n with a confidence of 95 % (the rule of three).
    const double error = all.sum == 0 ? 3 / static_cast<double>(all.pairs) : all.standard_error();
    return {all.mean(), error, 2 * all.pairs};
}

}  // namespace patchlight
