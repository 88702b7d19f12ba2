#include "apps/patchlight/commands.h"
#include "apps/patchlight/progress_display.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/verify_report.h"
#include "apps/study/check_study.h"
#include "apps/study/shown_points.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <ctime>
#include <optional>

namespace patchlight {

namespace {

/// The cycles to verify, the one that was asked for last.
std::vector<CycleRecord> cycles_of(const OpenedRun& run, const VerifyCommand& command)
{
    if (!command.all_cycles) return {record_of(run, command.cycle)};
    (void)record_of(run, {});  // throws where there is none
    return run.record.cycles;
}

Verification trace(const Scene& scene, std::size_t elements, const std::vector<DrawnPoint>& points,
                   const std::vector<std::vector<ShownPoint>>& shown, const VerifyOptions& options, Session& session)
{
    const RayCaster caster(scene);
    ProgressDisplay display(session.messages);
    const WorkMonitor monitor{
        session.interruption.token(), [&](const WorkState& state) {
            display.show(
                {.stage = "paths", .cycle = -1, .fraction = state.fraction, .elements = elements, .rays = state.rays});
        }};
    return verify_light(scene, caster, points, shown, options, monitor);
}

/// Whether every file is what the run wrote; tells which isn't.
bool files_are_whole(const OpenedRun& run, const VerifyCommand& command, const Session& session)
{
    const std::vector<FileProblem> problems = check_files(run);
    for (const FileProblem& problem : problems)
        session.messages.error("files", fmt::format("{}: {}; solve the run again, or bring the file back",
                                                    (run.folder / problem.file).string(), problem.cause));
    if (command.files_only && command.json)
        write_result(json_text(run, problems));
    else if (command.files_only && problems.empty())
        write_result(fmt::format("{}: {} files are what the run wrote\n", command.run, run.record.files.size()));
    return problems.empty();
}

int verify(const VerifyCommand& command, Session& session)
{
    const OpenedRun run = open_run(command.run);
    if (!files_are_whole(run, command, session)) return 3;
    if (command.files_only) return 0;
    session.interruption.check();
    const std::vector<CycleRecord> cycles = cycles_of(run, command);
    const StoredSolution last = solution_of(run, command.cycle);
    const VerifyOptions options{command.points, command.most_paths, command.seed, {}};
    const std::vector<DrawnPoint> points = points_to_verify(last.scene, options);
    std::vector<std::vector<ShownPoint>> shown;
    for (std::size_t i = 0; i + 1 < cycles.size(); ++i) {
        session.interruption.check();
        shown.push_back(shown_at(solution_of(run, {WhichCycle::Kind::number, cycles[i].cycle}), points));
    }
    shown.push_back(shown_at(last, points));
    session.interruption.check();

    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    const Verification found = trace(last.scene, last.mesh.patch_count(), points, shown, options, session);
    VerifyReport report{.seed = command.seed, .points = points.size(), .rays = found.rays, .paths = found.paths};
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    report.cpu_seconds = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    for (std::size_t i = 0; i < cycles.size(); ++i)
        report.cycles.push_back(verified_cycle(cycles[i], found.solutions[i]));
    report.surfaces = errors_by_surface(found.solutions.back().points);
    write_result(command.json ? json_text(report, last.scene) : summary_text(report, last.scene));
    session.messages.note(
        fmt::format("{:.1f} M rays in {:.1f} s", 1e-6 * static_cast<double>(found.rays), report.seconds));
    return 0;
}

/// The files of all runs of a study; with --points each cell is path-traced, too.
int verify_study(const VerifyCommand& command, Session& session)
{
    const StudyFolder folder{command.run};
    if (command.json && command.traces_study) {
        throw UsageError("usage", "--json: of a study it tells of files alone; leave out --points");
    }
    const StudyCheck check = check_study(folder);
    for (const FileProblem& problem : check.problems)
        session.messages.error("files", fmt::format("{}: {}; run the study again, or bring the file back",
                                                    (folder.root / problem.file).string(), problem.cause));
    if (command.json)
        write_result(json_text(check));
    else if (check.problems.empty())
        write_result(
            fmt::format("{}: {} files of {} runs are what was written\n", command.run, check.files, check.runs.size()));
    if (!check.problems.empty()) return 3;
    for (const std::filesystem::path& run : check.runs) {
        if (!command.traces_study || run.parent_path().parent_path().filename() != "cells") continue;
        session.interruption.check();
        write_result(fmt::format("\n{}\n", run.string()));
        VerifyCommand own = command;
        own.run = run.string();
        verify(own, session);
    }
    return 0;
}

}  // namespace

int run_command(const VerifyCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    try {
        return is_study_folder(command.run) ? verify_study(command, session) : verify(command, session);
    } catch (const Interrupted&) {
        session.messages.note("interrupted");
        return session.interruption.exit_code();
    }
}

}  // namespace patchlight
