#include "apps/study/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace patchlight {

namespace {

/// Slope of y on x and its standard error. Needs two different x.
void fit_line(const std::vector<double>& x, const std::vector<double>& y, FittedOrder& fit)
{
    const double n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    const double slope = xy / xx;
    fit.order = -slope;
    if (x.size() < 3) return;
    double rest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = y[i] - mean_y - slope * (x[i] - mean_x);
        rest += r * r;
    }
    fit.standard_error = std::sqrt(rest / (n - 2) / xx);
}

FittedOrder order_over(const StudyResult& study, const StudySeries& series, double (*x_of)(const CycleResult&))
{
    std::vector<CurvePoint> points;
    for (const std::size_t c : series.cells) {
        const CellResult& cell = study.cells[c];
        CurvePoint point{0, std::numeric_limits<double>::quiet_NaN()};
        if (ran_to_its_end(cell)) {
            const CycleResult& last = cell.cycles.back();
            point = {x_of(last), error_of(study, last).value_or(point.error)};
        }
        points.push_back(point);
    }
    return fitted_order(points);
}

}  // namespace

bool is_on_log_axes(const CurvePoint& point)
{
    return point.x > 0 && std::isfinite(point.x) && point.error > 0 && std::isfinite(point.error);
}

FittedOrder fitted_order(std::span<const CurvePoint> points)
{
    FittedOrder fit;
    std::vector<double> x, y;
    for (const CurvePoint& point : points) {
        fit.local.emplace_back();
        if (!is_on_log_axes(point)) continue;
        const double here = std::log(point.x), error = std::log(point.error);
        if (!x.empty() && here != x.back()) fit.local.back() = (y.back() - error) / (here - x.back());
        x.push_back(here);
        y.push_back(error);
    }
    fit.points = x.size();
    if (const std::size_t left_out = points.size() - x.size(); left_out > 0)
        fit.note = fmt::format("{} of {} left out: no error, or 0", left_out, points.size());
    const auto add = [&](const char* why) { fit.note += (fit.note.empty() ? "" : "; ") + std::string(why); };
    if (x.empty())
        add("no point");
    else if (x.size() == 1)
        add("one point");
    else if (std::ranges::all_of(x, [&](double v) { return v == x.front(); }))
        add("all points at one place");
    else
        fit_line(x, y, fit);
    return fit;
}

std::vector<SeriesRates> rates_of(const StudyResult& study)
{
    std::vector<SeriesRates> all;
    for (const StudySeries& series : series_of(study)) {
        all.push_back({series,
                       order_over(study, series, [](const CycleResult& c) { return static_cast<double>(c.elements); }),
                       order_over(study, series, [](const CycleResult& c) { return c.seconds; })});
    }
    return all;
}

}  // namespace patchlight
