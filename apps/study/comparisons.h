#pragma once

#include "apps/study/rates.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// What is compared: the error at equal elements or seconds; what an equal error costs.
enum class ComparedQuantity { error, elements, seconds };

std::string name_of(ComparedQuantity quantity);
std::string name_of(StudyComparison::At at);

struct ComparedValue {
    std::optional<double> value;    ///< unset outside what the series reaches: nothing is extrapolated
    std::optional<double> to_best;  ///< value over the least of the row's; 1: the best
};

/// The series of one scene, at one place of one axis.
struct ComparedRow {
    std::string scene;
    StudyComparison::At at = StudyComparison::At::elements;
    double place = 0;
    ComparedQuantity quantity = ComparedQuantity::error;
    std::vector<ComparedValue> values;  ///< one each of `series`
    std::vector<std::size_t> series;    ///< places in what series_of() gives
};

/// A curve's error at x: a straight line on log–log axes between the neighbouring points. Unset outside the points. Of
/// points with one x the least error counts; what can't stand on logarithmic axes is left out.
std::optional<double> error_at(std::span<const CurvePoint> curve, double x);

/// The least x from which on a curve has an error: where the lines of error_at() first fall to it. Unset when they
/// never do, or when the first point is below it already.
std::optional<double> first_with(std::span<const CurvePoint> curve, double error);

/// All comparisons that the study asks for, those of seconds (of the clock, so different each time) only with
/// `with_seconds`. A series' curve are its cells that ran to their end; where there is one alone, its cycles.
std::vector<ComparedRow> compared(const StudyResult& study, bool with_seconds);

}  // namespace patchlight
