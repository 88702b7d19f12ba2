#include "apps/verification/measured_error.h"

#include "formfactor/random_numbers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <limits>
#include <map>
#include <utility>

namespace patchlight {

namespace {

double sum_of(const Rgb& x)
{
    return x.r + x.g + x.b;
}

/// √(a/b) of what should be squares; 0/0 = 0.
double root_ratio(double a, double b)
{
    if (!(a > 0)) return 0;
    return b > 0 ? std::sqrt(a / b) : std::numeric_limits<double>::infinity();
}

/// What a point adds to the sums that errors are made from.
struct Terms {
    double error = 0, light = 0;                         ///< of l2²
    double relative = 0, counted = 0;                    ///< of relrms²
    double noise = 0, relative_noise = 0, of_paths = 0;  ///< variances of found, relative, and of `error`

    Terms& operator+=(const Terms& t)
    {
        error += t.error;
        light += t.light;
        relative += t.relative;
        counted += t.counted;
        noise += t.noise;
        relative_noise += t.relative_noise;
        of_paths += t.of_paths;
        return *this;
    }
    double l2() const { return root_ratio(error, light); }
    double relrms() const { return root_ratio(relative, counted); }
};

Terms terms_of(const MeasuredPoint& p, double dimmest)
{
    Terms t;
    for (int band = 0; band < 3; ++band) {
        const double found2 = p.found[band] * p.found[band], v = p.variance[band];
        const double d = p.shown[band] - p.found[band], squared = d * d - v;
        t.error += squared;
        t.light += found2 - v;
        t.noise += v;
        t.of_paths += 2 * v * v + 4 * std::max(0.0, squared) * std::max(0.0, v);
        if (!(p.found[band] > 0) || p.found[band] < dimmest) continue;
        t.relative += squared / found2;
        t.relative_noise += v / found2;
        t.counted += 1;
    }
    return t;
}

std::vector<Terms> terms_of(std::span<const MeasuredPoint> points)
{
    double mean = 0;
    for (const MeasuredPoint& p : points) mean += sum_of(p.found) / (3 * static_cast<double>(points.size()));
    std::vector<Terms> terms(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) terms[i] = terms_of(points[i], 1e-3 * mean);
    return terms;
}

/// The middle 95 %.
Interval middle(std::vector<double>& values)
{
    std::ranges::sort(values);
    const std::size_t tail = values.size() / 40;
    return {values[tail], values[values.size() - 1 - tail]};
}

void find_intervals(const std::vector<Terms>& terms, std::uint64_t seed, MeasuredError& result)
{
    constexpr std::size_t samples = 1000;
    std::vector<double> l2(samples), relrms(samples);
    const auto n = static_cast<std::uint32_t>(terms.size());
    tbb::parallel_for(std::size_t{0}, samples, [&](std::size_t k) {
        RandomNumbers random(seed, k);
        Terms sum;
        for (std::uint32_t i = 0; i < n; ++i) sum += terms[random.below(n)];
        l2[k] = sum.l2();
        relrms[k] = sum.relrms();
    });
    result.l2_ci = middle(l2);
    result.relrms_ci = middle(relrms);
}

/// The share of the variance of Σ error / Σ light, by the delta method, that the paths' noise makes.
double share_from_paths(const std::vector<Terms>& terms, const Terms& sum)
{
    const double ratio = sum.light > 0 ? sum.error / sum.light : 0;
    double variance = 0;
    for (const Terms& t : terms) {
        const double z = t.error - ratio * t.light;
        variance += z * z;
    }
    return variance > 0 ? std::min(1.0, sum.of_paths / variance) : 0;
}

}  // namespace

MeasuredError measured_error(std::span<const MeasuredPoint> points, std::uint64_t seed)
{
    MeasuredError result;
    if (points.empty()) return result;
    const std::vector<Terms> terms = terms_of(points);
    Terms sum;
    for (const Terms& t : terms) sum += t;
    result.l2 = sum.l2();
    result.relrms = sum.relrms();
    result.relrms_values = static_cast<std::size_t>(sum.counted);
    result.l2_noise = root_ratio(sum.noise, sum.light);
    result.relrms_noise = root_ratio(sum.relative_noise, sum.counted);
    result.from_paths = share_from_paths(terms, sum);
    find_intervals(terms, seed, result);
    return result;
}

std::vector<SurfaceError> errors_by_surface(std::span<const MeasuredPoint> points)
{
    std::map<SurfaceId, std::pair<Terms, std::size_t>> by_surface;
    Terms all;
    for (const MeasuredPoint& p : points) {
        const Terms t = terms_of(p, 0);
        all += t;
        auto& [sum, count] = by_surface[p.surface];
        sum += t;
        ++count;
    }
    std::vector<SurfaceError> errors;
    for (const auto& [surface, of] : by_surface)
        errors.push_back({surface, of.second, of.first.l2(), all.error > 0 ? of.first.error / all.error : 0});
    return errors;
}

PointShares shares_within(std::span<const MeasuredPoint> points,
                          const std::function<double(const MeasuredPoint&)>& limit)
{
    PointShares shares;
    const double one = 1 / static_cast<double>(points.size());
    for (const MeasuredPoint& p : points) {
        const double most = limit(p), error = glm::length(p.shown - p.found);
        const double doubt = 3 * std::sqrt(sum_of(p.variance));
        (error + doubt <= most ? shares.within : error - doubt > most ? shares.beyond : shares.undecided) += one;
    }
    return shares;
}

EstimateCheck check_estimate(double estimated, const MeasuredError& measured)
{
    const auto over = [estimated](double error) {
        if (error > 0) return estimated / error;
        return estimated > 0 ? std::numeric_limits<double>::infinity() : 1.0;
    };
    EstimateCheck check{over(measured.l2), {over(measured.l2_ci.high), over(measured.l2_ci.low)}, Verdict::undecided};
    constexpr double least = 0.5, most = 3;
    if (check.range.high < least) check.verdict = Verdict::too_small;
    if (check.range.low > most) check.verdict = Verdict::too_large;
    if (check.range.low >= least && check.range.high <= most) check.verdict = Verdict::holds;
    return check;
}

}  // namespace patchlight
