#include "apps/patchlight/commands.h"
#include "apps/patchlight/given_mesh.h"
#include "apps/patchlight/progress_display.h"
#include "apps/patchlight/seen_points.h"
#include "apps/patchlight/study_plan.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <set>

namespace patchlight {

namespace {

/// A killed `study run` leaves children that are just about to stop.
constexpr std::chrono::seconds patience{3};

const StudyCell& cell_of(const StudyPlanner& planner, std::size_t index)
{
    const auto& cells = planner.cells();
    const auto found = std::ranges::find(cells, index, &StudyCell::index);
    if (found == cells.end()) {
        throw UsageError("usage", fmt::format("--index: {} has no cell {}; it has {} from {} to {}",
                                              planner.study().file.string(), index, cells.size(), cells.front().index,
                                              cells.back().index));
    }
    return *found;
}

int solve_cell(StudyPlanner& planner, const StudyFolder& folder, const StudyCellCommand& command, Session& session)
{
    const StudyCell& cell = cell_of(planner, *command.index);
    PlannedSolve plan = planner.solve_of(cell);
    const std::string id = run_id(plan.identity);
    plan.command.run = folder.run(id).string();
    plan.command.json = command.json;
    FileWriter::make_folder(folder.cell(id));
    const FolderLock lock(folder.cell(id), patience);
    FileWriter::sweep(folder.cell(id));
    return solve_planned(plan, planner.scene_of(cell).input, planner.scene_of(cell).caster, session);
}

/// The run that the reference is taken from, solved if need be. Returns solve's exit code.
int solve_reference(const PlannedReference& planned, StudyScene& scene, const std::filesystem::path& run,
                    Session& session)
{
    PlannedSolve plan = scene.plan(*planned.solve);
    plan.command.run = run.string();
    const int code = solve_planned(plan, scene.input, scene.caster, session);
    return open_run(run).record.status == RunStatus::finished ? code : 4;
}

std::vector<ReferencePoint> traced(const StudyPlanner& planner, const StudyScene& scene,
                                   const std::vector<DrawnPoint>& points, const std::filesystem::path& blocks,
                                   Session& session)
{
    ProgressDisplay display(session.messages);
    const auto tell = [&](double fraction, std::size_t rays) {
        display.show({.stage = "paths", .cycle = -1, .fraction = fraction, .rays = rays});
    };
    return traced_reference(scene.input.scene, scene.caster, points, planner.study().reference.paths, planner.seed(),
                            {blocks, session.writer, session.interruption.token(), tell});
}

std::vector<ReferencePoint> given(const StudyReference& reference, const Scene& scene)
{
    const std::string name = reference.file.string();
    return given_reference(scene, read_points(read_bytes(reference.file), name), name);
}

/// The light at the reference's points, by its kind; its run is there.
std::vector<ReferencePoint> found_reference(const StudyPlanner& planner, const StudyScene& scene,
                                            const std::filesystem::path& folder, Session& session)
{
    const StudyReference& reference = planner.study().reference;
    const Scene& of = scene.input.scene;
    const std::vector<DrawnPoint> points =
        reference.seen_from.empty()
            ? reference_points(of, reference, planner.seed())
            : draw_seen_points(of, scene.caster, chosen_view(reference.seen_from, of, scene.caster), reference.points,
                               reference_seeds(planner.seed()).points);
    switch (reference.kind) {
    case ReferenceKind::path_traced:
        return traced(planner, scene, points, folder / "blocks", session);
    case ReferenceKind::solution:
        return shown_reference(solution_of(open_run(folder / "run"), {}), points);
    case ReferenceKind::run:
        return shown_reference(solution_lit_alike(reference.file.string(), of), points);
    case ReferenceKind::points:
        return given(reference, of);
    case ReferenceKind::furnace:
        return furnace_reference(of, points, planner.study().file.string());
    case ReferenceKind::none:
        break;
    }
    return {};
}

int make_reference(StudyPlanner& planner, const PlannedReference& planned, StudyScene& scene, const StudyFolder& folder,
                   Session& session)
{
    const std::filesystem::path own = folder.reference(planned.id);
    FileWriter::make_folder(own);
    const FolderLock lock(own, patience);
    FileWriter::sweep(own);
    std::error_code error;
    if (std::filesystem::exists(own / "reference.json", error)) {
        session.messages.note(fmt::format("{}: this reference is finished already", own.string()));
    } else {
        if (planned.solve) {
            if (const int code = solve_reference(planned, scene, own / "run", session); code != 0) return code;
        }
        write_reference(own, planned.key, found_reference(planner, scene, own, session), session.writer);
    }
    std::filesystem::remove_all(own / "blocks", error);
    return 0;
}

/// One reference a scene; cells that light it otherwise have another scene.
int make_references(StudyPlanner& planner, const StudyFolder& folder, Session& session)
{
    std::set<std::string> made;
    int worst = 0;
    for (const StudyCell& cell : planner.cells()) {
        session.interruption.check();
        const PlannedReference planned = planner.reference_of(cell);
        if (planned.id.empty() || !made.insert(planned.id).second) continue;
        worst = std::max(worst, make_reference(planner, planned, planner.scene_of(cell), folder, session));
    }
    if (made.empty()) session.messages.note("this study has no reference");
    return worst;
}

}  // namespace

int run_command(const StudyCellCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    if (!command.reference && !command.index) {
        throw UsageError("usage", "one of --index and --reference is needed");
    }
    const StudyFolder folder = study_folder(command.study, command.folder);
    refuse_foreign(folder);
    StudyPlanner planner(command.study);
    return command.reference ? make_references(planner, folder, session)
                             : solve_cell(planner, folder, command, session);
}

}  // namespace patchlight
