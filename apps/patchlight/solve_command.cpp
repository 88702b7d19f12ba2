#include "apps/patchlight/before_after_table.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/cost_estimate.h"
#include "apps/patchlight/kept_factors.h"
#include "apps/patchlight/planned_solve.h"
#include "apps/patchlight/solve_run.h"
#include "apps/report/report_page.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <optional>
#include <system_error>

namespace patchlight {

namespace {

/// The demo's scene stands in its own output folder.
constexpr const char* demo_scene_folder = "scene";

std::vector<std::string> gather_warnings(const SceneInput& input, const RayCaster& caster, const Session& session)
{
    std::vector<std::string> warnings = input.report.warnings;
    for (std::string& warning : first_hit_warnings(sample_first_hits(input.scene, caster))) {
        warnings.push_back(std::move(warning));
    }
    for (const std::string& warning : warnings) {
        session.messages.warning(warning);
    }
    return warnings;
}

std::string summary_of(const RunFolder& folder)
{
    const RunRecord record = folder.record();
    const RunIdentity& id = record.identity;
    std::string out = fmt::format("scene   {}: {} surfaces, {:.6g} m2, {}\n", id.scene_file, id.surfaces, id.area,
                                  id.closed ? "closed" : "open");
    const Json timing = folder.timing();
    out += fmt::format("\n{}\n", before_after_table(record, timing));
    if (!record.cycles.empty()) {
        const EnergyBalance& e = record.cycles.back().energy;
        out += fmt::format("energy  emitted {:.6g} W, absorbed {:.6g} W, escaped {:.6g} W, rest {:.2g} %\n", e.emitted,
                           e.absorbed, e.escaped, 100 * e.relative_residual);
    }
    std::error_code error;
    for (const char* name : {"before.png", "after.png", "compare.png", "mesh-before.png", "mesh-after.png", "view.exr",
                             "solution.glb", "run.json", "report.html"}) {
        if (std::filesystem::exists(folder.path() / name, error)) {
            out += fmt::format("wrote   {}\n", (folder.path() / name).string());
        }
    }
    if (timing.is_object() && timing.contains("seconds") && timing["seconds"].contains("total")) {
        out += fmt::format("seconds {:.1f}\n", timing["seconds"]["total"].get<double>());
    }
    return out;
}

int report(const RunFolder& folder, const SolveCommand& command, const Session& session)
{
    const RunRecord record = folder.record();
    write_result(command.json ? read_bytes(folder.path() / "run.json") : summary_of(folder));
    if (record.status == RunStatus::finished) {
        return 0;
    }
    const CycleRecord& last = record.cycles.back();
    session.messages.error(
        "converged", last.solver_converged
                         ? fmt::format("the target error was not reached: {:.3g} % is left; raise --max-elements "
                                       "or --iterations",
                                       100 * last.estimated_error)
                         : "the linear solver did not reach its tolerance: light comes round too often for it; try "
                           "--solver bicgstab or conjugate-gradient, or smaller reflectances");
    return 4;
}

/// The demo ends with its report.
void write_demo_report(const SolveCommand& command, Session& session)
{
    if (command.demo) {
        session.writer.write(std::filesystem::path(command.run) / "report.html",
                             report_page(open_run(command.run)).html);
    }
}

std::vector<std::string> also_ours(const SolveCommand& command)
{
    return command.demo ? std::vector<std::string>{demo_scene_folder} : std::vector<std::string>{};
}

/// The demo's folder is the program's own: a demo of another version or size in it makes room.
void open_folder(std::optional<RunFolder>& folder, const SolveCommand& command, const RunIdentity& identity,
                 Session& session)
{
    try {
        folder.emplace(command.run, identity, session.writer, also_ours(command));
    } catch (const FolderRefused&) {
        std::error_code error;
        const std::filesystem::path run = command.run;
        if (!command.demo || !std::filesystem::exists(run / "run.json", error) ||
            open_run(run).record.identity.scene_file != identity.scene_file) {
            throw;
        }
        clear_run(run);
        folder.emplace(command.run, identity, session.writer, also_ours(command));
    }
}

}  // namespace

int solve_planned(const PlannedSolve& plan, const SceneInput& input, const RayCaster& caster, Session& session)
{
    const SolveCommand& command = plan.command;
    if (command.time > 0) session.interruption.stop_after(command.time);
    check_factors_fit(command, check_memory(input.scene, command.options, command.memory), session);
    const std::vector<std::string> warnings = gather_warnings(input, caster, session);
    session.interruption.check();

    std::optional<RunFolder> folder;
    open_folder(folder, command, plan.identity, session);
    if (folder->state() == FolderState::finished) {
        session.messages.note(fmt::format("{}: this run is finished already", command.run));
        write_demo_report(command, session);
        report(*folder, command, session);
        return 0;
    }
    solve_into(*folder, input, caster, plan.view, command, warnings, session,
               factors_of_run(command, input.scene, caster, session));
    write_demo_report(command, session);
    return report(*folder, command, session);
}

int run_command(const SolveCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    SceneInput input = load_scene(command.scene);
    session.interruption.check();
    const RayCaster caster(input.scene);
    const PlannedSolve plan = plan_solve(command, input, caster);
    session.interruption.check();
    return solve_planned(plan, input, caster, session);
}

}  // namespace patchlight
