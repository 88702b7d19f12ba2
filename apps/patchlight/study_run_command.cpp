#include "apps/patchlight/commands.h"
#include "apps/patchlight/progress_display.h"
#include "apps/patchlight/study_jobs.h"
#include "apps/patchlight/study_outputs.h"
#include "apps/patchlight/study_plan.h"
#include "apps/study/study_json.h"
#include "apps/study/tables.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <set>

namespace patchlight {

namespace {

bool is_ended(const StudyFolder& folder, const std::string& id)
{
    std::error_code error;
    if (!std::filesystem::exists(folder.run(id) / "run.json", error)) return false;
    try {
        const RunStatus status = open_run(folder.run(id)).record.status;
        return status == RunStatus::finished || status == RunStatus::not_converged;
    } catch (const std::exception&) {
        return false;  // its own command says what is wrong with it
    }
}

bool has_references(const StudyPlan& plan, const StudyFolder& folder)
{
    std::error_code error;
    return std::ranges::all_of(plan.cells, [&](const PlannedCell& cell) {
        return cell.reference.empty() ||
               std::filesystem::exists(folder.reference(cell.reference) / "reference.json", error);
    });
}

/// What is still to be done, the references first: a cell is a command of its own.
std::list<StudyJob> jobs_of(const StudyPlan& plan, const StudyFolder& folder, const StudyRunCommand& command)
{
    std::vector<std::string> common{"--quiet", "-o", folder.root.string()};
    const auto jobs_at_once = static_cast<int>(command.jobs);
    if (command.threads > 0 || jobs_at_once > 1) {
        const int threads = command.threads > 0 ? command.threads : tbb::info::default_concurrency();
        common.insert(common.end(), {"--threads", std::to_string(std::max(1, threads / jobs_at_once))});
    }
    const auto arguments = [&](std::vector<std::string> own) {
        std::vector<std::string> all{"study", "cell"};
        all.insert(all.end(), own.begin(), own.end());
        all.insert(all.end(), common.begin(), common.end());
        all.insert(all.end(), {"--", command.study});
        return all;
    };
    std::list<StudyJob> jobs;
    if (!has_references(plan, folder)) jobs.push_back({"reference", "", arguments({"--reference"})});
    std::set<std::string> seen;
    for (const PlannedCell& cell : plan.cells) {
        if (!cell.problem.empty() || !seen.insert(cell.id).second || is_ended(folder, cell.id)) continue;
        jobs.push_back({cell.cell.name, cell.id, arguments({"--index", std::to_string(cell.cell.index)}),
                        plan.study.limits.seconds});
    }
    return jobs;
}

/// Tells of what ends, and keeps why cells failed.
class StudyProgress {
public:
    StudyProgress(const StudyPlan& plan, const StudyFolder& folder, std::size_t jobs, Session& session)
        : folder_(folder), session_(session), display_(session.messages), limit_(plan.study.limits.seconds), jobs_(jobs)
    {
        show();
    }

    void begun(const StudyJob& job) const
    {
        if (!job.id.empty()) remove_outcome(folder_, job.id);
    }

    void ended(const StudyJob& job, const StudyJobEnd& end)
    {
        ++done_;
        const std::string place = fmt::format("{}/{} {}", done_, jobs_, job.name);
        const bool solved = !job.id.empty() && is_ended(folder_, job.id);
        if (solved || end.exit_code == 0) {
            session_.messages.note(fmt::format("{}  {}{:.1f} s", place, solved ? found(job.id) : "", end.seconds));
        } else if (end.over_time) {
            const std::string message = fmt::format("stopped after {:.6g} s, the study's limit", limit_);
            session_.messages.note(fmt::format("{}  {}; run the study again and it goes on", place, message));
            write_outcome(folder_, job.id, {CellStatus::over_time, message}, session_.writer);
        } else {
            failed(job, place, end.message);
        }
        show();
    }

    bool failed_reference() const { return failed_reference_; }

private:
    void failed(const StudyJob& job, const std::string& place, const std::string& message)
    {
        if (job.id.empty()) {
            failed_reference_ = true;
            session_.messages.error("reference", message);
            return;
        }
        session_.messages.note(fmt::format("{}  {}", place, message));
        write_outcome(folder_, job.id, {CellStatus::failed, message}, session_.writer);
    }

    void show()
    {
        if (done_ == jobs_) return display_.clear();
        display_.show(
            {.stage = "cells", .cycle = -1, .fraction = static_cast<double>(done_) / static_cast<double>(jobs_)});
    }

    std::string found(const std::string& id) const
    {
        const RunRecord record = open_run(folder_.run(id)).record;
        const CycleRecord& last = record.cycles.back();
        return fmt::format("{} elements  estimated error {:.3g} %{}  ", last.elements, 100 * last.estimated_error,
                           record.status == RunStatus::finished ? "" : "  not converged");
    }

    const StudyFolder& folder_;
    Session& session_;
    ProgressDisplay display_;
    double limit_ = 0;
    std::size_t jobs_ = 0, done_ = 0;
    bool failed_reference_ = false;
};

/// The cells that aren't done, each with its reason. Returns how many.
std::size_t name_failures(const StudyResult& result, const Session& session)
{
    std::size_t count = 0;
    for (const CellResult& cell : result.cells) {
        if (cell.status == CellStatus::done) continue;
        ++count;
        const std::string reason = cell.message.empty() ? "" : ": " + cell.message;
        session.messages.error("study", fmt::format("cell {} ({}) is {}{}", cell.cell.index, cell.cell.name,
                                                    name_of(cell.status), reason));
    }
    return count;
}

}  // namespace

int run_command(const StudyRunCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    const StudyFolder folder = study_folder(command.study, command.folder);
    refuse_foreign(folder);
    StudyPlan plan = StudyPlanner(command.study).plan();
    session.interruption.check();
    FileWriter::make_folder(folder.root);
    const FolderLock lock(folder.root);
    FileWriter::sweep(folder.root);
    session.writer.write(folder.root / "study.toml", read_bytes(command.study));

    std::list<StudyJob> jobs = jobs_of(plan, folder, command);
    StudyProgress progress(plan, folder, jobs.size(), session);
    work_through(
        std::move(jobs), command.jobs, session.interruption.token(), [&](const StudyJob& job) { progress.begun(job); },
        [&](const StudyJob& job, const StudyJobEnd& end) { progress.ended(job, end); });

    const StudyResult result = collect(plan, folder, &session.writer, session.interruption.token());
    const std::string json = study_json(plan, result);
    session.writer.write(folder.root / "study.json", json);
    session.writer.write(folder.root / "timing.json", study_timing_json(result));
    write_study_outputs(plan.study.pictures, result, folder, session);
    write_result(command.json ? json : table_text(result));
    const std::size_t failures = name_failures(result, session) + name_failed_gates(result, session);
    return failures > 0 || progress.failed_reference() ? 4 : 0;
}

}  // namespace patchlight
