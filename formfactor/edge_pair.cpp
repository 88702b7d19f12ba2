#include "formfactor/edge_pair.h"

#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {

namespace {

/// Directions whose sine is below this are taken as parallel: the edges move by less than rounding leaves of them.
constexpr double parallel_sine = 1e-13;

/// K″ = ½ ln(u² + h²), what parallel edges at distance h need:
/// K(u) = ¼(u² − h²) ln(u² + h²) − ¾u² + h u atan(u/h).
double second_antiderivative(double u, double h)
{
    const double rr = u * u + h * h;
    if (rr == 0) return 0;
    const double arc = h > 0 ? h * u * std::atan(u / h) : 0;
    return 0.25 * (u * u - h * h) * std::log(rr) - 0.75 * u * u + arc;
}

/// ∫∫ ln r ds dt over parallel edges; `way` is 1 where they run the same way, −1 against each other.
double parallel_edges(const Edge& a, const Edge& b, double way)
{
    const Vec3 between = b.start - a.start;
    const double t0 = glm::dot(between, a.direction);
    const double h = glm::length(between - t0 * a.direction);
    const double t1 = t0 + way * b.length;
    return way * (second_antiderivative(a.length - t0, h) + second_antiderivative(-t1, h) -
                  second_antiderivative(a.length - t1, h) - second_antiderivative(-t0, h));
}

/// ∫ ln|x − y| dy over the edge: u ½ln(u² + h²) − u + h atan(u/h), the two arcs taken together as the edge's angle.
double inner_integral(const Vec3& x, const Edge& inner)
{
    const Vec3 from_start = x - inner.start;
    const double foot = glm::dot(from_start, inner.direction);
    const Vec3 across = from_start - foot * inner.direction;
    const double hh = glm::dot(across, across);
    const double t0 = -foot, t1 = inner.length - foot;
    const double r0 = t0 * t0 + hh, r1 = t1 * t1 + hh;
    double sum = -inner.length;
    if (r1 > 0) sum += 0.5 * t1 * std::log(r1);
    if (r0 > 0) sum -= 0.5 * t0 * std::log(r0);
    const double h = std::sqrt(hh);
    if (h > 0) sum += h * std::atan2(h * inner.length, hh + t0 * t1);
    return sum;
}

/// Where the inner integral, continued to complex places s on the outer edge, stops being analytic: s = place ± i off.
struct Singularity {
    double place = 0, off = 0;
};

/// At the distance 0 from either end of the inner edge (a logarithm), and where the outer line meets the inner one
/// between its ends (a kink |h|).
class Singularities {
public:
    Singularities(const Edge& outer, const Edge& inner)
    {
        add_end(outer, inner.start);
        add_end(outer, inner.start + inner.length * inner.direction);
        const Vec3 normal = glm::cross(outer.direction, inner.direction);
        const double sine = glm::length(normal), cosine = glm::dot(outer.direction, inner.direction);
        const Vec3 between = inner.start - outer.start;
        const double along = glm::dot(between, outer.direction), against = glm::dot(between, inner.direction);
        const double on_inner = (along * cosine - against) / (sine * sine);
        if (on_inner > 0 && on_inner < inner.length)
            found_[count_++] = {along + on_inner * cosine, std::abs(glm::dot(between, normal)) / (sine * sine)};
    }

    /// The sum ρ of the half axes of the largest Bernstein ellipse around [a, b] free of singularities, and the
    /// singularity on it.
    double ellipse(double a, double b, Singularity& nearest) const
    {
        const double half = 0.5 * (b - a), middle = 0.5 * (a + b);
        double least = 1e300;
        for (int i = 0; i < count_; ++i) {
            const double x = (found_[i].place - middle) / half, y = found_[i].off / half;
            const double foci = std::sqrt((x - 1) * (x - 1) + y * y) + std::sqrt((x + 1) * (x + 1) + y * y);
            const double axis = std::max(1.0, 0.5 * foci);
            if (axis >= least) continue;
            least = axis;
            nearest = found_[i];
        }
        return least + std::sqrt(least * least - 1);
    }

private:
    void add_end(const Edge& outer, const Vec3& end)
    {
        const Vec3 between = end - outer.start;
        const double place = glm::dot(between, outer.direction);
        found_[count_++] = {place, glm::length(between - place * outer.direction)};
    }

    std::array<Singularity, 3> found_;
    int count_ = 0;
};

template <unsigned n>
double gauss(const Edge& outer, const Edge& inner, double a, double b)
{
    using Rule = boost::math::quadrature::gauss<double, n>;
    const auto& nodes = Rule::abscissa();
    const auto& weights = Rule::weights();
    const double half = 0.5 * (b - a);
    const Vec3 middle = outer.start + 0.5 * (a + b) * outer.direction;
    double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 step = half * nodes[i] * outer.direction;
        double value = inner_integral(middle + step, inner);
        if (nodes[i] != 0) value += inner_integral(middle - step, inner);
        sum += weights[i] * value;
    }
    return half * sum;
}

/// Where to cut [a, b] so that both pieces are freer of the singularity than the whole.
double cut(double a, double b, const Singularity& nearest)
{
    const double margin = 0.1 * (b - a);
    if (nearest.place > a + margin && nearest.place < b - margin) return nearest.place;
    // Geometric grading towards an end: with 0.15 the outer piece has ρ > 2.2, so 25 nodes do.
    if (nearest.place <= a + margin) return a + std::max(0.15 * (b - a), nearest.place > a ? nearest.place - a : 0.0);
    return b - std::max(0.15 * (b - a), nearest.place < b ? b - nearest.place : 0.0);
}

struct OuterIntegral {
    const Edge& outer;
    const Edge& inner;
    Singularities singularities;
    double digits;    ///< −ln of the tolerance
    double shortest;  ///< below this a piece's whole error is within the tolerance

    double over(double a, double b) const
    {
        Singularity nearest;
        const double rho = singularities.ellipse(a, b, nearest);
        // The rule's error falls like ρ^(−2n).
        const double nodes = digits / (2 * std::log(rho));
        if (nodes <= 7) return gauss<7>(outer, inner, a, b);
        if (nodes <= 10) return gauss<10>(outer, inner, a, b);
        if (nodes <= 15) return gauss<15>(outer, inner, a, b);
        if (nodes <= 25 || b - a < shortest) return gauss<25>(outer, inner, a, b);
        const double c = cut(a, b, nearest);
        return over(a, c) + over(c, b);
    }
};

}  // namespace

double edge_pair_integral(const Edge& outer, const Edge& inner, double tolerance)
{
    const double cosine = glm::dot(outer.direction, inner.direction);
    const Vec3 normal = glm::cross(outer.direction, inner.direction);
    if (glm::dot(normal, normal) < parallel_sine * parallel_sine)
        return cosine * parallel_edges(outer, inner, cosine > 0 ? 1.0 : -1.0);
    // Perpendicular but for rounding.
    if (std::abs(cosine) < 4e-16) return 0;
    const double allowed = std::clamp(tolerance / std::abs(cosine), 1e-16, 1e-2);
    // A logarithm over a piece of length δ, beside another of its length, leaves less than δ² from a rule of 25 nodes.
    const OuterIntegral integral{outer, inner, Singularities(outer, inner), -std::log(0.1 * allowed),
                                 outer.length * std::sqrt(allowed)};
    return cosine * integral.over(0, outer.length);
}

}  // namespace patchlight
