#include "apps/study/comparisons.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace patchlight {

namespace {

using Curve = std::vector<CurvePoint>;

/// By x, each once with its least error.
Curve in_order(std::span<const CurvePoint> points)
{
    std::map<double, double> least;
    for (const CurvePoint& point : points) {
        if (!is_on_log_axes(point)) continue;
        const auto [place, is_new] = least.try_emplace(point.x, point.error);
        if (!is_new) place->second = std::min(place->second, point.error);
    }
    Curve curve;
    for (const auto& [x, error] : least) curve.push_back({x, error});
    return curve;
}

/// On the line through (a, fa) and (b, fb) of log–log axes; exact at both.
double between(double a, double fa, double b, double fb, double x)
{
    if (x == a) return fa;
    if (x == b) return fb;
    return fa * std::exp(std::log(fb / fa) * std::log(x / a) / std::log(b / a));
}

double elements_in(const CycleResult& cycle)
{
    return static_cast<double>(cycle.elements);
}

double seconds_in(const CycleResult& cycle)
{
    return cycle.seconds;
}

Curve curve_of(const StudyResult& study, const StudySeries& series, double (*x_of)(const CycleResult&))
{
    std::vector<const CellResult*> cells;
    for (const std::size_t c : series.cells)
        if (ran_to_its_end(study.cells[c])) cells.push_back(&study.cells[c]);
    Curve curve;
    const auto add = [&](const CycleResult& cycle) {
        if (const auto error = error_of(study, cycle)) curve.push_back({x_of(cycle), *error});
    };
    if (cells.size() == 1)
        for (const CycleResult& cycle : cells.front()->cycles) add(cycle);
    else
        for (const CellResult* cell : cells) add(cell->cycles.back());
    return curve;
}

void set_ratios(std::vector<ComparedValue>& values)
{
    std::optional<double> best;
    for (const ComparedValue& v : values)
        if (v.value && (!best || *v.value < *best)) best = v.value;
    for (ComparedValue& v : values)
        if (v.value) v.to_best = *v.value / *best;
}

/// One row of a comparison: every series of a scene.
ComparedRow row_of(const StudyResult& study, const std::vector<StudySeries>& series, ComparedRow row)
{
    const bool over_seconds = row.at == StudyComparison::At::seconds || row.quantity == ComparedQuantity::seconds;
    for (std::size_t s = 0; s < series.size(); ++s) {
        if (series[s].scene != row.scene) continue;
        const Curve curve = curve_of(study, series[s], over_seconds ? &seconds_in : &elements_in);
        row.series.push_back(s);
        row.values.push_back(
            {row.at == StudyComparison::At::error ? first_with(curve, row.place) : error_at(curve, row.place), {}});
    }
    set_ratios(row.values);
    return row;
}

std::vector<ComparedQuantity> quantities_at(StudyComparison::At at, bool with_seconds)
{
    if (at == StudyComparison::At::elements) return {ComparedQuantity::error};
    if (at == StudyComparison::At::error && !with_seconds) return {ComparedQuantity::elements};
    if (at == StudyComparison::At::error) return {ComparedQuantity::elements, ComparedQuantity::seconds};
    if (with_seconds) return {ComparedQuantity::error};
    return {};
}

}  // namespace

std::string name_of(ComparedQuantity quantity)
{
    switch (quantity) {
    case ComparedQuantity::error:
        return "error";
    case ComparedQuantity::elements:
        return "elements";
    case ComparedQuantity::seconds:
        return "seconds";
    }
    return "unknown";
}

std::string name_of(StudyComparison::At at)
{
    switch (at) {
    case StudyComparison::At::elements:
        return "elements";
    case StudyComparison::At::seconds:
        return "seconds";
    case StudyComparison::At::error:
        return "error";
    }
    return "unknown";
}

std::optional<double> error_at(std::span<const CurvePoint> curve, double x)
{
    const Curve points = in_order(curve);
    const auto right = std::ranges::lower_bound(points, x, {}, &CurvePoint::x);
    if (right == points.end()) return {};
    if (right->x == x) return right->error;
    if (right == points.begin()) return {};
    const CurvePoint& left = *std::prev(right);
    return between(left.x, left.error, right->x, right->error, x);
}

std::optional<double> first_with(std::span<const CurvePoint> curve, double error)
{
    const Curve points = in_order(curve);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].error > error) continue;
        if (points[i].error == error) return points[i].x;
        if (i == 0) return {};
        return between(points[i - 1].error, points[i - 1].x, points[i].error, points[i].x, error);
    }
    return {};
}

std::vector<ComparedRow> compared(const StudyResult& study, bool with_seconds)
{
    const std::vector<StudySeries> series = series_of(study);
    std::vector<std::string> scenes;
    for (const StudySeries& s : series)
        if (std::ranges::find(scenes, s.scene) == scenes.end()) scenes.push_back(s.scene);
    std::vector<ComparedRow> rows;
    for (const StudyComparison& comparison : study.comparisons)
        for (const ComparedQuantity quantity : quantities_at(comparison.at, with_seconds))
            for (const std::string& scene : scenes)
                for (const double place : comparison.values)
                    rows.push_back(row_of(study, series, {scene, comparison.at, place, quantity, {}, {}}));
    return rows;
}

}  // namespace patchlight
