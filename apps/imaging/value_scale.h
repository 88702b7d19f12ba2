#pragma once

#include <vector>

namespace patchlight {

enum class ScaleKind { linear, logarithmic };

/// Where numbers lie between the first colour of a map and the last.
struct ValueScale {
    ScaleKind kind = ScaleKind::linear;
    double low = 0;   ///< above 0 when logarithmic
    double high = 1;  ///< above low

    /// 0 at low and below, 1 at high and above; NaN for NaN.
    double position(double value) const;
    /// The value itself, or its logarithm: position() is linear in it. Not cut.
    double coordinate(double value) const;
};

/// Round numbers (1, 2, 5 × 10^n, or their multiples) from low to high, `most` at most, growing. A logarithmic scale
/// of less than a decade may have none.
std::vector<double> round_values(const ValueScale& scale, int most);

/// A scale on which `values` can be told apart: linear from 0 to a round number at their 99th percentile,
/// logarithmic between round numbers at their 1st and 99th, four decades at most. What isn't finite doesn't count;
/// without a positive value it is 0 … 1 (.1 … 1). The order of the values changes nothing.
ValueScale fitting_scale(std::vector<float> values, ScaleKind kind);

/// The smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10 × 10^n that isn't below a positive value; the largest not above
/// it.
double round_up(double value);
double round_down(double value);

}  // namespace patchlight
