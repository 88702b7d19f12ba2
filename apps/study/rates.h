#pragma once

#include "apps/study/series.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// A point of an error's curve over elements or seconds. NaN: not known.
struct CurvePoint {
    double x = 0;
    double error = 0;
};

/// Whether it can stand on logarithmic axes.
bool is_on_log_axes(const CurvePoint& point);

/// error ~ x^−order.
struct FittedOrder {
    std::optional<double> order;               ///< unset: `note` says why
    std::optional<double> standard_error;      ///< of three points or more
    std::vector<std::optional<double>> local;  ///< one a point: between it and the one before that counts
    std::size_t points = 0;                    ///< that the fit rests on
    std::string note;                          ///< what was left out, or why there is no order; mostly empty
};

/// Least squares of log error on log x, and the orders between neighbours. Points without a positive error or x are
/// left out. There is no order of fewer than two points or where all have one x; never a NaN.
FittedOrder fitted_order(std::span<const CurvePoint> points);

/// How a series' error falls.
struct SeriesRates {
    StudySeries series;
    FittedOrder by_elements;
    FittedOrder by_seconds;
};

/// Of all series, over their cells that ran to their end; `local` has one entry a cell of the series.
std::vector<SeriesRates> rates_of(const StudyResult& study);

}  // namespace patchlight
