#include "apps/study/study_json.h"

#include "apps/run/run_record.h"

#include <filesystem>

namespace patchlight {

namespace {

std::string text_of(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json number(const std::optional<double>& value)
{
    return value ? Json(*value) : Json();
}

/// Scenes by their names: where they are is the machine's affair.
std::string shown_value(const StudyAxis& axis, const std::string& value)
{
    return axis.name == "scene" ? std::filesystem::path(value).filename().string() : value;
}

Json json_of(const CycleResult& c)
{
    return {{"cycle", c.cycle},
            {"elements", c.elements},
            {"rays", c.rays},
            {"estimated_error", c.estimated_error},
            {"error", number(c.error)},
            {"error_ci", c.error_ci ? Json::array({c.error_ci->low, c.error_ci->high}) : Json()},
            {"max_error", number(c.max_error)},
            {"energy_residual", c.energy_residual}};
}

Json json_of(const CellResult& cell, const std::vector<StudyAxis>& axes)
{
    Json values = Json::object(), options = Json::object(), cycles = Json::array(), probes = Json::array();
    for (std::size_t i = 0; i < axes.size() && i < cell.cell.values.size(); ++i) {
        values[axes[i].name] = shown_value(axes[i], cell.cell.values[i]);
    }
    for (const OptionText& option : cell.cell.options) options[option.name] = option.value;
    for (const CycleResult& cycle : cell.cycles) cycles.push_back(json_of(cycle));
    for (const auto& B : cell.probes) probes.push_back(B ? patchlight::json_of(*B) : Json());
    return {{"index", cell.cell.index},
            {"scene", std::filesystem::path(cell.cell.scene).filename().string()},
            {"values", values},
            {"options", options},
            {"id", cell.id},
            {"status", name_of(cell.status)},
            {"message", cell.message},
            {"cycles", cycles},
            {"probes", probes}};
}

}  // namespace

std::string study_json(const StudyPlan& plan, const StudyResult& result)
{
    Json axes = Json::array(), cells = Json::array();
    for (const StudyAxis& axis : result.axes) {
        Json values = Json::array();
        for (const OptionText& value : axis.values) values.push_back(shown_value(axis, value.value));
        axes.push_back({{"name", axis.name}, {"values", values}});
    }
    for (const CellResult& cell : result.cells) cells.push_back(json_of(cell, result.axes));
    return text_of({{"schema", "patchlight-study/1"},
                    {"tool", {{"name", "patchlight"}, {"numeric", numeric_version()}}},
                    {"study", {{"name", result.name}, {"sha256", plan.sha256}, {"seed", plan.seed}}},
                    {"axes", axes},
                    {"along", result.along},
                    {"reference", name_of(result.reference.kind)},
                    {"cells", cells}});
}

std::string study_timing_json(const StudyResult& result)
{
    Json cells = Json::array();
    for (const CellResult& cell : result.cells) {
        Json seconds = Json::array();
        for (const CycleResult& cycle : cell.cycles) seconds.push_back(cycle.seconds);
        cells.push_back(
            {{"index", cell.cell.index}, {"id", cell.id}, {"seconds", seconds}, {"peak_memory", cell.peak_memory}});
    }
    return text_of({{"cells", cells}});
}

}  // namespace patchlight
