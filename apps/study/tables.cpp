#include "apps/study/tables.h"

#include "apps/study/comparisons.h"
#include "apps/study/gates.h"
#include "apps/study/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace patchlight {

namespace {

using Fields = std::vector<std::string>;

/// A cell at one of its cycles; without one where there is none yet.
struct TableRow {
    const CellResult& cell;
    const CycleResult* cycle = nullptr;
    std::optional<double> rate, rate_by_seconds;  ///< from the cell before it in its series
};

/// The orders between neighbours, by cell.
std::vector<std::optional<double>> local_rates(const StudyResult& study, const std::vector<SeriesRates>& rates,
                                               FittedOrder SeriesRates::*which)
{
    std::vector<std::optional<double>> of_cell(study.cells.size());
    for (const SeriesRates& series : rates)
        for (std::size_t i = 0; i < series.series.cells.size(); ++i)
            of_cell[series.series.cells[i]] = (series.*which).local[i];
    return of_cell;
}

std::vector<TableRow> rows_of(const StudyResult& study, const TableOptions& options)
{
    const auto rates = rates_of(study);
    const auto by_elements = local_rates(study, rates, &SeriesRates::by_elements);
    const auto by_seconds = local_rates(study, rates, &SeriesRates::by_seconds);
    std::vector<TableRow> rows;
    for (std::size_t c = 0; c < study.cells.size(); ++c) {
        const CellResult& cell = study.cells[c];
        if (options.cycles)
            for (std::size_t i = 0; i + 1 < cell.cycles.size(); ++i) rows.push_back({cell, &cell.cycles[i], {}, {}});
        rows.push_back({cell, cell.cycles.empty() ? nullptr : &cell.cycles.back(), by_elements[c], by_seconds[c]});
    }
    return rows;
}

/// The axes' names, made different from the columns that follow: solve has an option called elements, too.
Fields axis_heads(const StudyResult& study, const std::set<std::string>& taken)
{
    Fields heads;
    for (const StudyAxis& axis : study.axes)
        heads.push_back(taken.contains(axis.name) ? axis.name + " (option)" : axis.name);
    return heads;
}

Fields axis_values(const StudyResult& study, const CellResult& cell)
{
    Fields values = cell.cell.values;
    values.resize(study.axes.size());
    return values;
}

template <class Value, class Text>
std::string or_dash(const std::optional<Value>& value, const Text& text)
{
    return value ? text(*value) : "–";
}

std::string percent(double fraction)
{
    return rounded(100 * fraction, 3);
}

std::string order_text(double order)
{
    return fmt::format("{:.2f}", order + 0.0);
}

std::string error_text(const CycleResult& cycle)
{
    std::string text = or_dash(cycle.error, percent);
    if (cycle.error_ci) text += fmt::format(" ({}–{})", percent(cycle.error_ci->low), percent(cycle.error_ci->high));
    return text;
}

/// For reading: few digits, errors in per cent.
TextTable readable_cells(const StudyResult& study, const TableOptions& options)
{
    const bool measured = is_measured(study);
    TextTable table{axis_heads(study, {}), std::vector<bool>(study.axes.size(), false), {}};
    const auto column = [&](const char* head, bool shown, bool right = true) {
        if (!shown) return;
        table.heads.emplace_back(head);
        table.right.push_back(right);
    };
    column(options.cycles ? "cycle" : "cycles", true);
    column("elements", true);
    column("estimated error, %", true);
    column("error, %", measured);
    column("max, %", measured);
    column("rate", true);
    column("energy residual", true);
    column("seconds", options.seconds);
    column("MiB", options.seconds);
    column("status", true, false);
    for (const TableRow& row : rows_of(study, options)) {
        Fields fields = axis_values(study, row.cell);
        const auto add = [&](bool shown, const auto& text_of) {
            if (shown) fields.push_back(row.cycle ? text_of(*row.cycle) : "–");
        };
        add(true,
            [&](const CycleResult& c) { return std::to_string(options.cycles ? c.cycle : row.cell.cycles.size()); });
        add(true, [](const CycleResult& c) { return std::to_string(c.elements); });
        add(true, [](const CycleResult& c) { return percent(c.estimated_error); });
        add(measured, error_text);
        add(measured, [](const CycleResult& c) { return or_dash(c.max_error, percent); });
        add(true, [&](const CycleResult&) { return or_dash(row.rate, order_text); });
        add(true, [](const CycleResult& c) { return rounded(c.energy_residual, 2); });
        add(options.seconds, [](const CycleResult& c) { return rounded(c.seconds, 3); });
        add(options.seconds, [&](const CycleResult&) { return rounded(row.cell.peak_memory / 1048576, 3); });
        fields.push_back(name_of(row.cell.status));
        table.rows.push_back(std::move(fields));
    }
    return table;
}

std::string full_or_empty(const std::optional<double>& value)
{
    return value ? in_full(*value) : "";
}

/// For programs: every number in full, a column each.
TextTable full_cells(const StudyResult& study, const TableOptions& options)
{
    Fields columns{options.cycles ? "cycle" : "cycles",
                   "elements",
                   "estimated_error",
                   "error",
                   "error_low",
                   "error_high",
                   "max_error",
                   "rate",
                   "energy_residual"};
    if (options.seconds) columns.insert(columns.end(), {"seconds", "rate_by_seconds", "peak_memory"});
    columns.insert(columns.end(), {"status", "message"});
    TextTable table{axis_heads(study, {columns.begin(), columns.end()}), {}, {}};
    table.heads.insert(table.heads.begin(), "cell");
    table.heads.insert(table.heads.end(), columns.begin(), columns.end());
    for (const TableRow& row : rows_of(study, options)) {
        Fields fields = axis_values(study, row.cell);
        fields.insert(fields.begin(), std::to_string(row.cell.cell.index));
        if (const CycleResult* c = row.cycle) {
            const auto bound = [&](double Interval::*end) {
                return c->error_ci ? in_full((*c->error_ci).*end) : std::string();
            };
            fields.insert(fields.end(),
                          {std::to_string(options.cycles ? c->cycle : row.cell.cycles.size()),
                           std::to_string(c->elements), in_full(c->estimated_error), full_or_empty(c->error),
                           bound(&Interval::low), bound(&Interval::high), full_or_empty(c->max_error),
                           full_or_empty(row.rate), in_full(c->energy_residual)});
            if (options.seconds)
                fields.insert(fields.end(),
                              {in_full(c->seconds), full_or_empty(row.rate_by_seconds), in_full(row.cell.peak_memory)});
        }
        fields.resize(table.heads.size() - 2);
        fields.insert(fields.end(), {name_of(row.cell.status), row.cell.message});
        table.rows.push_back(std::move(fields));
    }
    return table;
}

std::string rates_section(const StudyResult& study, const TableOptions& options)
{
    if (study.along.empty()) return "";
    TextTable table{{"series", "rate", "±"}, {false, true, true}, {}};
    if (options.seconds) {
        table.heads.insert(table.heads.end(), {"by seconds", "±"});
        table.right.insert(table.right.end(), {true, true});
    }
    table.heads.insert(table.heads.end(), {"cells", "note"});
    table.right.insert(table.right.end(), {true, false});
    for (const SeriesRates& rates : rates_of(study)) {
        Fields fields{rates.series.name};
        const auto add = [&](const FittedOrder& fit) {
            fields.insert(fields.end(), {or_dash(fit.order, order_text), or_dash(fit.standard_error, order_text)});
        };
        add(rates.by_elements);
        if (options.seconds) add(rates.by_seconds);
        fields.insert(fields.end(), {std::to_string(rates.by_elements.points), rates.by_elements.note});
        table.rows.push_back(std::move(fields));
    }
    return fmt::format("\n## Rates\n\n{} ~ elements^−rate, along {}: least squares on logarithmic axes, ± its standard "
                       "error.\n\n{}",
                       is_measured(study) ? "Error" : "Estimated error", markdown_text(study.along), markdown(table));
}

std::string place_text(const ComparedRow& row)
{
    return row.at == StudyComparison::At::error ? percent(row.place) + " %" : in_full(row.place);
}

std::string compared_text(const ComparedRow& row, const ComparedValue& value)
{
    if (!value.value) return "—";
    const std::string text = row.quantity == ComparedQuantity::error      ? percent(*value.value)
                             : row.quantity == ComparedQuantity::elements ? fmt::format("{:.0f}", *value.value)
                                                                          : rounded(*value.value, 3);
    if (*value.to_best == 1) return text + " (best)";
    return fmt::format("{} ({} ×)", text, rounded(*value.to_best, 3));
}

/// Rows of one comparison and one scene: a column each, a line a series.
std::string comparison_section(const StudyResult& study, const std::vector<StudySeries>& series,
                               const std::vector<const ComparedRow*>& rows)
{
    const ComparedRow& first = *rows.front();
    TextTable table{{"series"}, {false}, {}};
    for (const std::size_t s : first.series) table.rows.push_back({series[s].name});
    for (const ComparedRow* row : rows) {
        table.heads.push_back(place_text(*row));
        table.right.push_back(true);
        for (std::size_t s = 0; s < row->values.size(); ++s)
            table.rows[s].push_back(compared_text(*row, row->values[s]));
    }
    const bool many_scenes = std::ranges::any_of(series, [&](const auto& s) { return s.scene != first.scene; });
    const std::string quantity = first.quantity != ComparedQuantity::error ? name_of(first.quantity)
                                 : is_measured(study)                      ? "error in %"
                                                                           : "estimated error in %";
    return fmt::format("\n## At equal {}: {}{}\n\n{}", name_of(first.at), quantity,
                       many_scenes ? ", " + markdown_text(first.scene) : "", markdown(table));
}

std::string comparisons_sections(const StudyResult& study, const TableOptions& options)
{
    const std::vector<StudySeries> series = series_of(study);
    const std::vector<ComparedRow> rows = compared(study, options.seconds);
    std::string text;
    for (std::size_t i = 0; i < rows.size();) {
        std::vector<const ComparedRow*> together;
        for (; i < rows.size() && (together.empty() || (rows[i].at == together.front()->at &&
                                                        rows[i].quantity == together.front()->quantity &&
                                                        rows[i].scene == together.front()->scene));
             ++i)
            together.push_back(&rows[i]);
        text += comparison_section(study, series, together);
    }
    if (!text.empty()) text += "\nIn brackets: times the best. —: beyond the series' cells; nothing is extrapolated.\n";
    return text;
}

std::string gates_section(const StudyResult& study)
{
    const auto results = check_gates(study);
    if (results.empty()) return "";
    TextTable table{{"gate", "of", "value", "bound", "", "note"}, {false, false, true, true, false, false}, {}};
    for (const GateResult& r : results)
        table.rows.push_back({r.gate, r.of, or_dash(r.value, [](double v) { return rounded(v, 4); }), in_full(r.bound),
                              r.passed ? "passed" : "FAILED", r.message});
    const auto failed = std::ranges::count(results, false, &GateResult::passed);
    return fmt::format("\n## Gates\n\n{} of {} passed.\n\n{}", results.size() - static_cast<std::size_t>(failed),
                       results.size(), markdown(table));
}

/// Why cells failed.
std::string messages_section(const StudyResult& study)
{
    std::string text;
    for (const CellResult& cell : study.cells)
        if (!cell.message.empty())
            text += fmt::format("- {}: {}: {}\n", markdown_text(cell.cell.name), name_of(cell.status),
                                markdown_text(cell.message));
    return text.empty() ? "" : "\n## Cells that say something\n\n" + text;
}

}  // namespace

std::string table_text(const StudyResult& study, const TableOptions& options)
{
    switch (options.format) {
    case TableFormat::csv:
        return csv(full_cells(study, options));
    case TableFormat::latex:
        return latex(readable_cells(study, options));
    case TableFormat::json:
        return table_json(study, options).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    case TableFormat::markdown:
        break;
    }
    return fmt::format("# {}\n\n{}", markdown_text(study.name), markdown(readable_cells(study, options))) +
           messages_section(study) + rates_section(study, options) + comparisons_sections(study, options) +
           gates_section(study);
}

}  // namespace patchlight
