#include "apps/patchlight/study_estimate.h"

#include "apps/patchlight/given_mesh.h"
#include "apps/patchlight/scene_input.h"
#include "apps/patchlight/study_options.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/probing.h"
#include "apps/run/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

namespace patchlight {

namespace {

/// Processor seconds of a path in the Cornell box, a few reflections long, with its rays to the emitters.
constexpr double seconds_per_path = 1e-6;

/// The file, and how it is read.
std::string scene_key(const SceneArguments& arguments)
{
    return arguments.file + '\n' + json_of(arguments.options).dump();
}

/// The scenes that cells ask for, each read once.
class Scenes {
public:
    const Scene& of(const SceneArguments& arguments)
    {
        const std::string key = scene_key(arguments);
        auto found = scenes_.find(key);
        if (found == scenes_.end()) found = scenes_.emplace(key, load_scene(arguments).scene).first;
        return found->second;
    }

private:
    std::map<std::string, Scene> scenes_;
};

std::string in_cell(const std::string& cause, const StudyCell& cell)
{
    return cell.values.empty() ? cause : fmt::format("{} (cell {})", cause, cell.name);
}

/// With the study's limit on memory.
SolveCommand solve_of(const Study& study, const StudyCell& cell, std::vector<OptionText> options)
{
    const bool has_memory = std::ranges::find(options, "memory", &OptionText::name) != options.end();
    if (!study.limits.memory.empty() && !has_memory)
        options.push_back({"memory", study.limits.memory, study.limits.memory_place});
    try {
        return solve_command_of(cell.scene, "cell", options, study.file);
    } catch (const UsageError& error) {
        throw UsageError(error.code(), in_cell(error.what(), cell));
    }
}

void check_points(const std::filesystem::path& file)
{
    std::string text;
    try {
        text = read_bytes(file);
    } catch (const std::runtime_error& problem) {
        throw PointsError(problem.what());
    }
    (void)read_points(text, file.string());
}

/// Files that a study names are there and can be read.
void check_files(const Study& study)
{
    if (!study.probes.empty()) check_points(study.probes);
    const StudyReference& reference = study.reference;
    if (reference.kind == ReferenceKind::points) check_points(reference.file);
    if (reference.kind == ReferenceKind::run) (void)open_run(reference.file);
}

void check_views(const Study& study, const Scene& scene)
{
    std::error_code ignored;
    for (const auto& [view] : study.pictures.views) {
        if (view.empty()) continue;
        if (std::filesystem::exists(view, ignored)) {
            (void)read_views(view, scene);
        } else {
            (void)view_named(view, scene);
        }
    }
}

CostEstimate cost_of(SolveCommand& command, const Scene& scene)
{
    if (!command.mesh_of.empty()) {
        const std::size_t elements = mesh_of_run(command.mesh_of, scene).arrays.triangles.size();
        command.options.max_elements = command.options.meshing.max_elements = elements;
    }
    return check_memory(scene, command.options, command.memory);
}

void add(CostEstimate& sum, const CostEstimate& cost)
{
    sum.elements += cost.elements;
    sum.rays += cost.rays;
    sum.cpu_seconds += cost.cpu_seconds;
    sum.bytes = std::max(sum.bytes, cost.bytes);
}

CostEstimate reference_cost(const Study& study, const std::optional<SolveCommand>& solve, Scenes& scenes)
{
    const StudyReference& reference = study.reference;
    CostEstimate cost;
    if (reference.kind == ReferenceKind::path_traced)
        cost.cpu_seconds = seconds_per_path * static_cast<double>(reference.points) * reference.paths;
    if (!solve) return cost;
    SolveCommand command = *solve;
    return cost_of(command, scenes.of(command.scene));
}

}  // namespace

StudyEstimate estimate_of(const Study& study, const Session& session)
{
    StudyEstimate estimate;
    Scenes scenes;
    std::vector<StudyCell> cells = expand(study);
    // All words before the first scene: what is quickly said is said at once.
    std::vector<SolveCommand> commands;
    std::map<std::string, std::optional<SolveCommand>> references;
    for (const StudyCell& cell : cells) {
        commands.push_back(solve_of(study, cell, cell.options));
        std::optional<SolveCommand>& reference = references[scene_key(commands.back().scene)];
        if (study.reference.kind == ReferenceKind::solution && !reference)
            reference = solve_of(study, cell, reference_options(study, cell));
    }
    check_files(study);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        session.interruption.check();
        const Scene& scene = scenes.of(commands[i].scene);
        check_views(study, scene);
        try {
            const CostEstimate cost = cost_of(commands[i], scene);
            estimate.cells.push_back({std::move(cells[i]), cost});
        } catch (const LimitError& error) {
            throw LimitError(in_cell(error.what(), cells[i]));
        }
    }
    for (const auto& [key, solve] : references) add(estimate.reference, reference_cost(study, solve, scenes));
    return estimate;
}

}  // namespace patchlight
