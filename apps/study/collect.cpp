#include "apps/study/collect.h"

#include "apps/run/sha256.h"
#include "apps/study/measure.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <map>

namespace patchlight {

namespace {

std::filesystem::path outcome_file(const StudyFolder& folder, const std::string& id)
{
    return folder.cell(id) / "outcome.json";
}

std::optional<CellOutcome> outcome_of(const StudyFolder& folder, const std::string& id)
{
    try {
        const Json json = Json::parse(read_bytes(outcome_file(folder, id)));
        const bool late = json.at("status") == name_of(CellStatus::over_time);
        return CellOutcome{late ? CellStatus::over_time : CellStatus::failed, json.at("message").get<std::string>()};
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

Measures measures_of(const StudyPlan& plan)
{
    Measures measures;
    measures.seed = plan.seed;
    if (plan.study.probes.empty()) return measures;
    std::string text;
    try {
        text = read_bytes(plan.study.probes);
    } catch (const std::runtime_error& problem) {
        throw PointsError(problem.what());
    }
    measures.probes = read_points(text, plan.study.probes.string());
    measures.probes_sha256 = sha256_hex(text);
    return measures;
}

/// What timing.json keeps: wall seconds from the run's beginning to the end of each cycle, and bytes.
struct Timing {
    std::vector<double> seconds;
    double peak_memory = 0;
};

Timing timing_of(const OpenedRun& run)
{
    Timing kept{.seconds = std::vector<double>(run.record.cycles.size(), 0.0)};
    try {
        const Json timing = Json::parse(read_bytes(run.folder / "timing.json"));
        double so_far = 0;
        for (std::size_t i = 0; i < kept.seconds.size(); ++i) {
            for (const auto& stage : timing.at("cycles").at(i).at("seconds")) so_far += stage.get<double>();
            kept.seconds[i] = so_far;
        }
        kept.peak_memory = timing.value("peak_memory", 0.0);
    } catch (const std::exception&) {
        // Only what the clock said is lost.
    }
    return kept;
}

std::vector<CycleResult> cycles_of(const OpenedRun& run, const std::vector<double>& seconds, const Measured& measured)
{
    std::vector<CycleResult> cycles;
    std::size_t rays = 0;
    for (std::size_t i = 0; i < run.record.cycles.size(); ++i) {
        const CycleRecord& record = run.record.cycles[i];
        rays += record.rays;
        const CycleError error = i < measured.cycles.size() ? measured.cycles[i] : CycleError{};
        cycles.push_back({.cycle = record.cycle,
                          .elements = record.elements,
                          .rays = rays,
                          .estimated_error = record.estimated_error,
                          .error = error.error,
                          .error_ci = error.error_ci,
                          .max_error = error.max_error,
                          .energy_residual = record.energy.relative_residual,
                          .seconds = seconds[i]});
    }
    return cycles;
}

CellStatus status_of(RunStatus status)
{
    switch (status) {
    case RunStatus::finished:
        return CellStatus::done;
    case RunStatus::not_converged:
        return CellStatus::not_converged;
    case RunStatus::running:
    case RunStatus::interrupted:
        break;
    }
    return CellStatus::unfinished;
}

CellResult result_of(const PlannedCell& planned, const StudyFolder& folder, const Measures& measures,
                     FileWriter* writer, const std::stop_token& stop)
{
    CellResult result;
    result.cell = planned.cell;
    result.id = planned.id;
    result.message = planned.problem;
    if (!planned.problem.empty()) {
        result.status = CellStatus::failed;
        return result;
    }
    std::error_code error;
    if (std::filesystem::exists(folder.run(planned.id) / "run.json", error)) {
        try {
            const OpenedRun run = open_run(folder.run(planned.id));
            result.status = status_of(run.record.status);
            const Measured found = measured(run, measures, folder.cell(planned.id) / "measured.json", writer, stop);
            const Timing timing = timing_of(run);
            result.cycles = cycles_of(run, timing.seconds, found);
            result.peak_memory = timing.peak_memory;
            result.probes = found.probes;
        } catch (const SceneError& problem) {
            result.status = CellStatus::failed;
            result.message = problem.what();
            return result;
        }
    }
    const bool ended = result.status == CellStatus::done || result.status == CellStatus::not_converged;
    if (const auto outcome = outcome_of(folder, planned.id); outcome && !ended) {
        result.status = outcome->status;
        result.message = outcome->message;
    }
    return result;
}

}  // namespace

void write_outcome(const StudyFolder& folder, const std::string& id, const CellOutcome& outcome, FileWriter& writer)
{
    FileWriter::make_folder(folder.cell(id));
    const Json json{{"status", name_of(outcome.status)}, {"message", outcome.message}};
    writer.write(outcome_file(folder, id), json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void remove_outcome(const StudyFolder& folder, const std::string& id)
{
    std::error_code error;
    std::filesystem::remove(outcome_file(folder, id), error);
}

StudyResult collect(const StudyPlan& plan, const StudyFolder& folder, FileWriter* writer, const std::stop_token& stop)
{
    const Study& study = plan.study;
    StudyResult result{study.name, study.axes, study.along, study.gates, study.comparisons, study.reference, {}};
    Measures measures = measures_of(plan);
    std::map<std::string, std::optional<std::vector<ReferencePoint>>> references;
    for (const PlannedCell& planned : plan.cells) {
        measures.reference = planned.reference;
        measures.points = nullptr;
        if (!planned.reference.empty()) {
            auto [found, is_new] = references.try_emplace(planned.reference);
            if (is_new) found->second = read_reference(folder.reference(planned.reference));
            if (found->second) measures.points = &*found->second;
        }
        result.cells.push_back(result_of(planned, folder, measures, writer, stop));
    }
    return result;
}

}  // namespace patchlight
