#include "formfactor/triangle_rules.h"

#include <boost/math/quadrature/gauss.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace patchlight {

namespace {

std::vector<TriangleNode> radon()
{
    const double root = std::sqrt(15.0);
    std::vector<TriangleNode> nodes{{1.0 / 3, 1.0 / 3, 9.0 / 40}};
    for (const double sign : {1.0, -1.0}) {
        const double a = (6 + sign * root) / 21, w = (155 + sign * root) / 1200;
        nodes.push_back({a, a, w});
        nodes.push_back({1 - 2 * a, a, w});
        nodes.push_back({a, 1 - 2 * a, w});
    }
    return nodes;
}

/// (u, v) on the unit square to (u(1 − v), uv): the Jacobian u takes one degree.
template <unsigned n>
std::vector<TriangleNode> folded()
{
    using Rule = boost::math::quadrature::gauss<double, n>;
    std::vector<std::pair<double, double>> line;  // on [0, 1]
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
        const double x = Rule::abscissa()[i], w = 0.5 * Rule::weights()[i];
        line.emplace_back(0.5 + 0.5 * x, w);
        if (x != 0) line.emplace_back(0.5 - 0.5 * x, w);
    }
    std::vector<TriangleNode> nodes;
    for (const auto& [u, wu] : line)
        for (const auto& [v, wv] : line) nodes.push_back({u * (1 - v), u * v, 2 * u * wu * wv});
    return nodes;
}

}  // namespace

std::span<const TriangleNode> triangle_rule(int degree)
{
    static const std::vector<TriangleNode> one{{1.0 / 3, 1.0 / 3, 1.0}};
    static const std::vector<TriangleNode> two{
        {1.0 / 6, 1.0 / 6, 1.0 / 3}, {2.0 / 3, 1.0 / 6, 1.0 / 3}, {1.0 / 6, 2.0 / 3, 1.0 / 3}};
    static const std::vector<TriangleNode> five = radon(), eight = folded<5>(), twelve = folded<7>(),
                                           fifteen = folded<9>();
    if (degree <= 1) return one;
    if (degree <= 2) return two;
    if (degree <= 5) return five;
    if (degree <= 8) return eight;
    if (degree <= 12) return twelve;
    if (degree <= 15) return fifteen;
    throw std::invalid_argument("no triangle rule of that degree");
}

}  // namespace patchlight
