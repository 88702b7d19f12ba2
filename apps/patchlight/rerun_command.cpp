#include "apps/patchlight/commands.h"
#include "apps/patchlight/cost_estimate.h"
#include "apps/patchlight/scene_input.h"
#include "apps/patchlight/seen_points.h"
#include "apps/patchlight/solve_run.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/check_files.h"
#include "apps/run/stored_scene.h"
#include "apps/run/whole_number.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <optional>

namespace patchlight {

namespace {

/// What there is to solve again, as it stood when the run was solved.
struct Repeated {
    SceneInput input;
    SolveCommand solve;
    View view;
};

SceneError broken(const OpenedRun& run, const std::string& cause)
{
    return {"run", fmt::format("{}: {}", run.folder.string(), cause)};
}

/// Throws UsageError for a run that hasn't ended, SceneError for one whose files aren't what it wrote.
void require_whole(const OpenedRun& run)
{
    const RunStatus status = run.record.status;
    if (status != RunStatus::finished && status != RunStatus::not_converged)
        throw UsageError("rerun", fmt::format("{} is {}: solve it to the end first, by the same command",
                                              run.folder.string(), name_of(status)));
    const std::vector<FileProblem> problems = check_files(run);
    if (!problems.empty()) throw broken(run, fmt::format("{} {}", problems.front().file, problems.front().cause));
}

PictureArguments pictures_in(const Json& json)
{
    PictureArguments pictures;
    pictures.pictures = json.at("written") == "all";
    pictures.size = {whole_number_in<int>(json.at("width")), whole_number_in<int>(json.at("height"))};
    pictures.snapshots = whole_numbers_in<int>(json.at("snapshots"));
    return pictures;
}

Repeated repeated(const OpenedRun& run)
{
    const RunIdentity& id = run.record.identity;
    StoredSolution last = solution_of(run, {});
    Repeated r{{std::move(last.scene), {}, id.scene_sha256}, {}, {}};
    if (scene_digest(r.input.scene) != id.content_sha256)
        throw broken(run, "the scene that it holds isn't the one that run.json names");
    try {
        SolveCommand& solve = r.solve;
        solve.scene.file = id.scene_file;
        solve.scene.options = scene_options_in(id.options.at("scene"));
        solve.options = adaptive_options_in(id.options.at("solve"));
        if (id.options.at("mesh").is_string()) {
            solve.mesh_of = run.folder.string();
            solve.mesh_sha256 = id.options.at("mesh").get<std::string>();
            solve.options.mesh = last.mesh.arrays();
        }
        if (id.options.at("for_view").is_object()) solve.goal = view_in(id.options.at("for_view"));
        solve.pictures = pictures_in(id.options.at("pictures"));
        if (solve.pictures.pictures) r.view = r.input.scene.views.at(0);
    } catch (const std::exception& problem) {
        throw broken(run, problem.what());
    }
    if (!same_run(identity_of(r.input, r.solve, r.view), id))
        throw broken(run, "it was solved with options that this version of patchlight doesn't have, or has more of");
    return r;
}

Json json_of(const RerunCommand& command, std::size_t files, const std::vector<FileProblem>& differing,
             const std::string& numeric)
{
    Json all{{"schema", "patchlight-rerun/1"},
             {"run", as_utf8(command.run)},
             {"rerun", as_utf8(command.output)},
             {"numeric", {{"run", numeric}, {"rerun", numeric_version()}}},
             {"files", files},
             {"identical", differing.empty()},
             {"differing", Json::array()}};
    for (const FileProblem& file : differing) all["differing"].push_back({{"file", file.file}, {"cause", file.cause}});
    return all;
}

int report(const RerunCommand& command, const OpenedRun& run, const Session& session)
{
    const OpenedRun again = open_run(command.output);
    const std::vector<FileProblem> differing = differing_files(run, again);
    const std::size_t files = run.record.files.size() + 1;  // and run.json
    const std::string numeric = run_record_in(read_bytes(run.folder / "run.json")).numeric;
    if (command.json)
        write_result(json_of(command, files, differing, numeric).dump(2, ' ', false, Json::error_handler_t::replace) +
                     "\n");
    else if (differing.empty())
        write_result(
            fmt::format("{}: all {} files are those of {}, to the byte\n", command.output, files, command.run));
    for (const FileProblem& file : differing)
        session.messages.error("rerun", fmt::format("{}: {}", file.file, file.cause));
    if (!differing.empty() && numeric != numeric_version())
        session.messages.note(fmt::format("{} was solved by a program of numeric version {}, this is {}", command.run,
                                          numeric.empty() ? "unknown" : numeric, numeric_version()));
    return differing.empty() ? 0 : 7;
}

}  // namespace

int run_command(const RerunCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    const OpenedRun run = open_run(command.run);
    require_whole(run);
    Repeated r = repeated(run);
    check_memory(r.input.scene, r.solve.options, command.memory);
    const RayCaster caster(r.input.scene);
    if (r.solve.goal) r.solve.options.looked_at = seen_points(r.input.scene, caster, *r.solve.goal);
    session.interruption.check();
    RunFolder folder(command.output, run.record.identity, session.writer);
    if (folder.state() != FolderState::finished)
        solve_into(folder, r.input, caster, r.view, r.solve, run.record.warnings, session);
    return report(command, run, session);
}

}  // namespace patchlight
