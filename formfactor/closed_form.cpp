#include "formfactor/closed_form.h"

#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string>

namespace patchlight {

namespace {

void require_lengths(const char* who, std::initializer_list<double> lengths)
{
    for (const double length : lengths)
        if (!(length > 0) || !std::isfinite(length))
            throw std::invalid_argument(std::string(who) + ": every length must be positive and finite");
}

/// x atan(1/x).
double times_own_arc_cotangent(double x)
{
    return x * std::atan2(1.0, x);
}

/// W² ln[W²(1+W²+H²)/((1+W²)(W²+H²))]: one minus a small fraction where the edge is short, W² H⁻² where it is long.
double weighted_logarithm(double w, double h)
{
    const double ww = w * w, hh = h * h;
    const double missing = hh / ((1 + ww) * (ww + hh));
    if (missing < 0.5) return ww * std::log1p(-missing);
    return ww * (std::log(ww / (ww + hh)) + std::log1p(hh / (1 + ww)));
}

}  // namespace

double parallel_rectangles(double a, double b, double c)
{
    require_lengths("parallel_rectangles", {a, b, c});
    const double X = std::min(a, b) / c, Y = std::max(a, b) / c;
    if (X < 0.25) {
        const auto integrand = [&](double u) {
            const double root = std::hypot(1.0, u);
            return (X - u) * std::atan(Y / root) / (root * root * root);
        };
        return 2 / (std::numbers::pi * X) * boost::math::quadrature::gauss<double, 20>::integrate(integrand, 0.0, X);
    }
    const double rx = std::hypot(1.0, X), ry = std::hypot(1.0, Y);
    const double braces = 0.5 * std::log1p(X * X * Y * Y / (1 + X * X + Y * Y)) +
                          X * (ry * std::atan(X / ry) - std::atan(X)) + Y * (rx * std::atan(Y / rx) - std::atan(Y));
    return 2 / (std::numbers::pi * X * Y) * braces;
}

double perpendicular_rectangles(double l, double w, double h)
{
    require_lengths("perpendicular_rectangles", {l, w, h});
    const double W = w / l, H = h / l;
    const double diagonal = std::hypot(W, H);
    const double arcs = times_own_arc_cotangent(W) + times_own_arc_cotangent(H) - times_own_arc_cotangent(diagonal);
    const double logarithms =
        std::log1p(W * W * H * H / (1 + W * W + H * H)) + weighted_logarithm(W, H) + weighted_logarithm(H, W);
    return (arcs + 0.25 * logarithms) / (std::numbers::pi * W);
}

double coaxial_discs(double r1, double r2, double h)
{
    require_lengths("coaxial_discs", {r1, r2, h});
    const double q = r2 / r1, H = h / r1;
    // S² − 4q² = (S − 2q)(S + 2q).
    const double S = 1 + q * q + H * H;
    const double root = std::sqrt(((1 - q) * (1 - q) + H * H) * ((1 + q) * (1 + q) + H * H));
    return 2 * q * q / (S + root);
}

}  // namespace patchlight
