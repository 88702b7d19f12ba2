#include "apps/study/comparisons.h"
#include "apps/study/gates.h"
#include "apps/study/tables.h"

namespace patchlight {

namespace {

Json json_of(const std::optional<double>& value)
{
    return value ? Json(*value) : Json(nullptr);
}

Json json_of(const CycleResult& c, bool seconds)
{
    Json out = {{"cycle", c.cycle},
                {"elements", c.elements},
                {"rays", c.rays},
                {"estimated_error", c.estimated_error},
                {"error", json_of(c.error)},
                {"error_ci", c.error_ci ? Json{c.error_ci->low, c.error_ci->high} : Json(nullptr)},
                {"max_error", json_of(c.max_error)},
                {"energy_residual", c.energy_residual}};
    if (seconds) out["seconds"] = c.seconds;
    return out;
}

Json json_of(const StudyResult& study, const CellResult& cell, const TableOptions& options)
{
    Json values = Json::object();
    for (std::size_t a = 0; a < study.axes.size() && a < cell.cell.values.size(); ++a)
        values[study.axes[a].name] = cell.cell.values[a];
    Json out = {{"index", cell.cell.index},
                {"name", cell.cell.name},
                {"id", cell.id},
                {"scene", scene_name(study, cell)},
                {"values", values},
                {"status", name_of(cell.status)},
                {"message", cell.message},
                {"cycles", cell.cycles.size()},
                {"result", cell.cycles.empty() ? Json(nullptr) : json_of(cell.cycles.back(), options.seconds)}};
    if (options.seconds) out["peak_memory"] = cell.peak_memory;
    if (!options.cycles) return out;
    out["cycles"] = Json::array();
    for (const CycleResult& cycle : cell.cycles) out["cycles"].push_back(json_of(cycle, options.seconds));
    return out;
}

Json json_of(const FittedOrder& fit)
{
    Json local = Json::array();
    for (const auto& rate : fit.local) local.push_back(json_of(rate));
    return {{"rate", json_of(fit.order)},
            {"standard_error", json_of(fit.standard_error)},
            {"local", local},
            {"cells", fit.points},
            {"note", fit.note}};
}

Json rates_json(const StudyResult& study, bool seconds)
{
    Json all = Json::array();
    for (const SeriesRates& rates : rates_of(study)) {
        Json cells = Json::array();
        for (const std::size_t c : rates.series.cells) cells.push_back(study.cells[c].cell.index);
        all.push_back({{"series", rates.series.name},
                       {"scene", rates.series.scene},
                       {"cells", cells},
                       {"by_elements", json_of(rates.by_elements)}});
        if (seconds) all.back()["by_seconds"] = json_of(rates.by_seconds);
    }
    return all;
}

Json comparisons_json(const StudyResult& study, bool seconds)
{
    const std::vector<StudySeries> series = series_of(study);
    Json all = Json::array();
    for (const ComparedRow& row : compared(study, seconds)) {
        Json values = Json::array();
        for (std::size_t i = 0; i < row.series.size(); ++i)
            values.push_back({{"series", series[row.series[i]].name},
                              {"value", json_of(row.values[i].value)},
                              {"to_best", json_of(row.values[i].to_best)}});
        all.push_back({{"scene", row.scene},
                       {"at", name_of(row.at)},
                       {"place", row.place},
                       {"quantity", name_of(row.quantity)},
                       {"values", values}});
    }
    return all;
}

}  // namespace

Json table_json(const StudyResult& study, const TableOptions& options)
{
    Json axes = Json::array(), cells = Json::array(), gates = Json::array();
    for (const StudyAxis& axis : study.axes) axes.push_back(axis.name);
    for (const CellResult& cell : study.cells) cells.push_back(json_of(study, cell, options));
    for (const GateResult& g : check_gates(study))
        gates.push_back({{"gate", g.gate},
                         {"of", g.of},
                         {"value", json_of(g.value)},
                         {"bound", g.bound},
                         {"passed", g.passed},
                         {"message", g.message}});
    return {{"schema", "patchlight-study-table/1"},
            {"name", study.name},
            {"axes", axes},
            {"along", study.along},
            {"error", is_measured(study) ? "measured" : "estimated"},
            {"cells", cells},
            {"rates", rates_json(study, options.seconds)},
            {"comparisons", comparisons_json(study, options.seconds)},
            {"gates", gates}};
}

}  // namespace patchlight
