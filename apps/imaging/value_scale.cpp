#include "apps/imaging/value_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace patchlight {

namespace {

constexpr std::array<double, 10> round_numbers{1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
constexpr double slack = 1e-9;  // 0.1 + 0.2 is still .3

/// m × 10^n; divides for negative n, so that .1 is .1 and not .1 + 1 ulp.
double times_power(double m, int n)
{
    return n < 0 ? m / std::pow(10.0, -n) : m * std::pow(10.0, n);
}

int decade_of(double value)
{
    return static_cast<int>(std::floor(std::log10(value) + slack));
}

std::vector<double> decades(const ValueScale& scale, const std::vector<double>& digits, int step)
{
    std::vector<double> values;
    for (int n = decade_of(scale.low); n <= decade_of(scale.high); ++n) {
        for (const double digit : digits) {
            const double value = times_power(digit, n);
            if (n % step == 0 && value >= scale.low * (1 - slack) && value <= scale.high * (1 + slack)) {
                values.push_back(value);
            }
        }
    }
    return values;
}

/// The finite positive value that a share of them doesn't exceed; 0 without any.
double percentile(std::vector<float>& values, double share)
{
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
}

}  // namespace

double ValueScale::coordinate(double value) const
{
    if (kind == ScaleKind::linear || std::isnan(value)) return value;
    return value > 0 ? std::log10(value) : -std::numeric_limits<double>::infinity();
}

double ValueScale::position(double value) const
{
    const double from = coordinate(low), to = coordinate(high);
    return std::clamp((coordinate(value) - from) / (to - from), 0.0, 1.0);
}

double round_up(double value)
{
    const int n = decade_of(value);
    for (const double number : round_numbers) {
        if (times_power(number, n) >= value * (1 - slack)) return times_power(number, n);
    }
    return times_power(10, n);
}

double round_down(double value)
{
    const int n = decade_of(value);
    double best = times_power(1, n);
    for (const double number : round_numbers) {
        if (times_power(number, n) <= value * (1 + slack)) best = times_power(number, n);
    }
    return best;
}

std::vector<double> round_values(const ValueScale& scale, int most)
{
    if (most < 1) return {};
    const auto fits = [&](const std::vector<double>& values) { return static_cast<int>(values.size()) <= most; };
    if (scale.kind == ScaleKind::logarithmic) {
        for (const std::vector<double>& digits : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
            if (auto values = decades(scale, digits, 1); fits(values)) return values;
        }
        for (int step = 2;; ++step) {
            if (auto values = decades(scale, {1}, step); fits(values)) return values;
        }
    }
    const double span = scale.high - scale.low;
    for (int n = decade_of(span / most);; ++n) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double step = times_power(digit, n);
            std::vector<double> values;
            const double first = std::ceil(scale.low / step - slack);
            for (double k = first; k * step <= scale.high + slack * span && fits(values); ++k) {
                values.push_back(k == 0 ? 0.0 : times_power(k * digit, n));
            }
            if (fits(values)) return values;
        }
    }
}

ValueScale fitting_scale(std::vector<float> values, ScaleKind kind)
{
    std::erase_if(values, [](float v) { return !std::isfinite(v); });
    if (kind == ScaleKind::logarithmic) std::erase_if(values, [](float v) { return v <= 0; });
    const double high = percentile(values, 0.99);
    if (!(high > 0)) return {kind, kind == ScaleKind::linear ? 0.0 : 0.1, 1.0};
    const double top = round_up(high);
    if (kind == ScaleKind::linear) return {kind, 0, top};
    const double low = round_down(std::max(percentile(values, 0.01), 1e-4 * top));
    return {kind, low < top ? low : top / 10, top};
}

}  // namespace patchlight
