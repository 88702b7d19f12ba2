#include "apps/patchlight/commands.h"
#include "apps/patchlight/study_estimate.h"
#include "apps/patchlight/study_options.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <thread>

namespace patchlight {

namespace {

constexpr std::size_t rows_shown = 50;

/// What a estimate comes to with so many cells at a time.
struct Totals {
    double cpu_seconds = 0;
    double bytes = 0;
};

/// Jobs share the processors: more of them save what one alone leaves idle, and need their memory at once.
Totals totals_of(const StudyEstimate& estimate, int jobs)
{
    Totals total{estimate.reference.cpu_seconds, 0};
    std::vector<double> bytes;
    for (const EstimatedCell& estimated : estimate.cells) {
        total.cpu_seconds += estimated.cost.cpu_seconds;
        bytes.push_back(estimated.cost.bytes);
    }
    std::ranges::sort(bytes, std::greater<>());
    bytes.resize(std::min(bytes.size(), static_cast<std::size_t>(jobs)));
    for (const double one : bytes) total.bytes += one;
    total.bytes = std::max(total.bytes, estimate.reference.bytes);
    return total;
}

Json json_of(const StudyReference& reference)
{
    Json j{{"kind", name_of(reference.kind)}};
    if (reference.kind != ReferenceKind::none && reference.kind != ReferenceKind::points)
        j["points"] = reference.points;
    if (reference.kind == ReferenceKind::path_traced) j["paths"] = reference.paths;
    if (!reference.file.empty()) j["file"] = as_utf8(reference.file.string());
    for (const OptionText& option : reference.options) j["options"][option.name] = option.value;
    return j;
}

Json json_of(const StudyGates& gates)
{
    Json j = Json::object();
    const auto add = [&](const char* name, const std::optional<double>& value) {
        if (value) j[name] = *value;
    };
    add("min_rate", gates.min_rate);
    add("max_error", gates.max_error);
    add("max_energy_residual", gates.max_energy_residual);
    add("min_effectivity", gates.min_effectivity);
    add("max_effectivity", gates.max_effectivity);
    return j;
}

Json json_of(const CostEstimate& cost)
{
    return {{"elements", cost.elements}, {"rays", cost.rays}, {"bytes", cost.bytes}, {"cpu_seconds", cost.cpu_seconds}};
}

Json json_of(const Study& study, const StudyEstimate& estimate, int jobs)
{
    Json axes = Json::array(), cells = Json::array();
    for (const StudyAxis& axis : study.axes) {
        Json values = Json::array();
        for (const OptionText& value : axis.values) values.push_back(value.value);
        axes.push_back({{"name", axis.name}, {"values", values}});
    }
    for (const auto& [cell, cost] : estimate.cells) {
        Json options = Json::object();
        for (const OptionText& option : cell.options) options[option.name] = option.value;
        cells.push_back({{"index", cell.index},
                         {"name", as_utf8(cell.name)},
                         {"scene", as_utf8(cell.scene)},
                         {"options", options},
                         {"cost", json_of(cost)}});
    }
    const Totals total = totals_of(estimate, jobs);
    return {{"schema", "patchlight-study-check/1"},
            {"study", as_utf8(study.name)},
            {"axes", axes},
            {"grid", grid_size(study)},
            {"along", study.along},
            {"reference", json_of(study.reference)},
            {"reference_cost", json_of(estimate.reference)},
            {"gates", json_of(study.gates)},
            {"cells", cells},
            {"total",
             {{"cells", estimate.cells.size()},
              {"jobs", jobs},
              {"bytes", total.bytes},
              {"cpu_seconds", total.cpu_seconds}}}};
}

std::string bytes_text(double bytes)
{
    constexpr double mib = 1024.0 * 1024, gib = 1024 * mib;
    return bytes >= gib ? fmt::format("{:.1f} GiB", bytes / gib) : fmt::format("{:.3g} MiB", bytes / mib);
}

std::string seconds_text(double seconds)
{
    return seconds < 100    ? fmt::format("{:.2g} s", seconds)
           : seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60)
                            : fmt::format("{:.3g} h", seconds / 3600);
}

/// What the study would do, above its cells.
std::string head_of(const Study& study, const StudyEstimate& estimate)
{
    std::string out = fmt::format("study      {}\n", study.name);
    for (const OptionText& scene : study.scenes) out += fmt::format("scene      {}\n", scene.value);
    std::vector<std::string> factors;
    for (const StudyAxis& axis : study.axes) factors.push_back(fmt::format("{} {}", axis.values.size(), axis.name));
    out +=
        fmt::format("cells      {}{}{}\n", estimate.cells.size(),
                    factors.empty() ? "" : fmt::format(" of {}", fmt::join(factors, " x ")),
                    study.skips.empty() ? "" : fmt::format(", {} skipped", grid_size(study) - estimate.cells.size()));
    if (!study.along.empty()) out += fmt::format("along      {}\n", study.along);
    out += fmt::format("reference  {}", name_of(study.reference.kind));
    const Json reference = json_of(study.reference);
    for (const auto& [name, value] : reference.items())
        if (name != "kind")
            out += fmt::format(", {} {}", name, value.is_string() ? value.get<std::string>() : value.dump());
    out += "\ngates      ";
    const Json gates = json_of(study.gates);
    for (const auto& [name, value] : gates.items())
        out += fmt::format("{}{} {}", out.ends_with(' ') ? "" : ", ", name, value.get<double>());
    return out + (gates.empty() ? "none\n" : "\n");
}

/// One row a cell, columns as wide as what they hold.
std::string rows_of(const Study& study, const StudyEstimate& estimate)
{
    std::vector<std::vector<std::string>> rows(1);
    rows[0].emplace_back("cell");
    for (const StudyAxis& axis : study.axes) rows[0].push_back(axis.name);
    for (const char* name : {"elements", "memory", "processor"}) rows[0].emplace_back(name);
    for (const auto& [cell, cost] : estimate.cells) {
        if (rows.size() > rows_shown) break;
        std::vector<std::string> row{std::to_string(cell.index)};
        row.insert(row.end(), cell.values.begin(), cell.values.end());
        row.insert(row.end(), {std::to_string(cost.elements), bytes_text(cost.bytes), seconds_text(cost.cpu_seconds)});
        rows.push_back(std::move(row));
    }
    std::string out;
    std::vector<std::size_t> widths(rows[0].size());
    for (const auto& row : rows)
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    for (const auto& row : rows) {
        for (std::size_t k = 0; k < row.size(); ++k)
            out += fmt::format("{}{:>{}}", k == 0 ? "" : "  ", row[k], widths[k]);
        out += "\n";
    }
    if (estimate.cells.size() > rows_shown) out += fmt::format("... and {} more\n", estimate.cells.size() - rows_shown);
    return out;
}

std::string table_of(const Study& study, const StudyEstimate& estimate, int jobs)
{
    const Totals total = totals_of(estimate, jobs);
    const unsigned threads = std::max(1U, std::thread::hardware_concurrency());
    std::string out = head_of(study, estimate) + "\n" + rows_of(study, estimate);
    if (estimate.reference.cpu_seconds > 0) {
        out += fmt::format("\nreference  about {} of processor time\n", seconds_text(estimate.reference.cpu_seconds));
    }
    return out + fmt::format("{}total      about {} of processor time, {} on {} threads; {} with {} job{}\n",
                             estimate.reference.cpu_seconds > 0 ? "" : "\n", seconds_text(total.cpu_seconds),
                             seconds_text(total.cpu_seconds / threads), threads, bytes_text(total.bytes), jobs,
                             jobs == 1 ? "" : "s");
}

}  // namespace

int run_command(const StudyCheckCommand& command, Session& session)
{
    const Study study = read_study_file(command.study).study;
    const StudyEstimate estimate = estimate_of(study, session);
    write_result(command.json
                     ? json_of(study, estimate, command.jobs).dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                     : table_of(study, estimate, command.jobs));
    return 0;
}

}  // namespace patchlight
