#include "apps/patchlight/compare_report.h"

#include "apps/run/stored_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace patchlight {

namespace {

/// JSON has no infinity.
Json number(double value)
{
    return std::isfinite(value) ? Json(value) : Json();
}

Json json_of(const ComparedSide& side, bool with_seconds)
{
    Json json = {{"run", as_utf8(side.name)},
                 {"cycle", side.cycle.cycle},
                 {"elements", side.cycle.elements},
                 {"estimated_error", number(side.cycle.estimated_error)}};
    if (with_seconds) json["seconds"] = side.seconds ? Json(*side.seconds) : Json();
    return json;
}

std::string seconds_text(const ComparedSide& side)
{
    return side.seconds ? fmt::format("{:.1f}", *side.seconds) : "-";
}

std::string row(const std::string& name, const std::string& a, const std::string& b)
{
    return fmt::format("{:<18} {:>20} {:>20}\n", name, a, b);
}

std::string percent(double value)
{
    return fmt::format("{:.3g} %", 100 * value);
}

}  // namespace

double CompareReport::value(Metric metric) const
{
    switch (metric) {
    case Metric::flip:
        return flip.mean;
    case Metric::flip_p95:
        return flip.p95;
    case Metric::flip_max:
        return flip.max;
    case Metric::rmse:
        return rmse;
    case Metric::l2:
        return l2.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    return std::numeric_limits<double>::quiet_NaN();
}

Json json_of(const CompareReport& r, bool with_seconds)
{
    Json view = json_of(r.view);
    view["name"] = as_utf8(r.view.name);
    Json json = {{"schema", "patchlight-compare/1"},
                 {"tool", {{"name", "patchlight"}, {"version", tool_version()}, {"commit", tool_commit()}}},
                 {"a", json_of(r.a, with_seconds)},
                 {"b", json_of(r.b, with_seconds)},
                 {"view", view},
                 {"width", r.width},
                 {"height", r.height},
                 {"exposure", r.exposure},
                 {"rmse", number(r.rmse)},
                 {"flip", {{"mean", r.flip.mean}, {"p95", r.flip.p95}, {"max", r.flip.max}}}};
    json["l2"] = r.l2 ? number(*r.l2) : Json();
    json["points"] = r.points;
    json["seed"] = r.seed;
    json["files"] = r.files;
    return json;
}

std::string table_of(const CompareReport& r)
{
    std::string text = row("", "A", "B");
    text += row("cycle", std::to_string(r.a.cycle.cycle), std::to_string(r.b.cycle.cycle));
    text += row("elements", std::to_string(r.a.cycle.elements), std::to_string(r.b.cycle.elements));
    text += row("estimated error", percent(r.a.cycle.estimated_error), percent(r.b.cycle.estimated_error));
    text += row("seconds", seconds_text(r.a), seconds_text(r.b));
    text += fmt::format("\nRMSE of radiance   {:.4g} W/(m2 sr)\n", r.rmse);
    text += fmt::format("FLIP               mean {:.4f}, 95 % below {:.4f}, largest {:.4f}\n", r.flip.mean, r.flip.p95,
                        r.flip.max);
    if (r.l2) text += fmt::format("L2 of A against B  {} at {} points\n", percent(*r.l2), r.points);
    return text;
}

std::vector<std::string> broken_limits(const CompareReport& report, const std::vector<CompareLimit>& limits)
{
    std::vector<std::string> broken;
    for (const CompareLimit& limit : limits) {
        const double value = report.value(limit.metric);
        if (!(value <= limit.value)) {
            broken.push_back(fmt::format("{} is {:.6g}, over {:.6g}", limit.name, value, limit.value));
        }
    }
    return broken;
}

}  // namespace patchlight
