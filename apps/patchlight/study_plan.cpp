#include "apps/patchlight/study_plan.h"

#include "apps/patchlight/study_options.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/sha256.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <string_view>

namespace patchlight {

namespace {

const OptionText* find(const std::vector<OptionText>& options, std::string_view name)
{
    const auto found = std::ranges::find(options, name, &OptionText::name);
    return found == options.end() ? nullptr : &*found;
}

/// Solves in it differ from cells' in how they are computed, never in what is lit.
constexpr std::array<std::string_view, 4> scene_options{"unit", "two-sided", "emitter", "max-reflectance"};

std::string digest_of_file(const std::filesystem::path& file)
{
    try {
        return sha256_hex(read_bytes(file));
    } catch (const std::runtime_error& problem) {
        throw PointsError(problem.what());
    }
}

}  // namespace

std::string run_id(const RunIdentity& identity)
{
    return content_id({{"scene", identity.scene_sha256},
                       {"content", identity.content_sha256},
                       {"options", identity.options},
                       {"seed", identity.seed},
                       {"numeric", numeric_version()}});
}

StudyFolder study_folder(const std::string& study_file, const std::string& given)
{
    const std::string stem = std::filesystem::path(study_file).stem().string();
    return {given.empty() ? std::filesystem::path(stem + "-study") : std::filesystem::path(given)};
}

void refuse_foreign(const StudyFolder& folder)
{
    constexpr std::array<std::string_view, 9> ours{"study.toml", "study.json", "table.md", "table.csv",  "timing.json",
                                                   "cells",      "references", "pictures", "report.html"};
    const std::filesystem::path& root = folder.root;
    std::error_code error;
    if (!std::filesystem::exists(root, error)) return;
    if (!std::filesystem::is_directory(root, error)) {
        throw FolderRefused(fmt::format("{} is a file; name a new folder", root.string()));
    }
    const auto has = [&](const char* name) { return std::filesystem::exists(root / name, error); };
    const bool marked = has("study.toml") || has("cells") || has("references");
    for (const auto& entry : std::filesystem::directory_iterator(root)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with('.')) continue;  // unfinished files of ours, and what file systems and schedulers leave
        if (!marked || std::ranges::find(ours, name) == ours.end()) {
            throw FolderRefused(
                fmt::format("{} holds {}, which is no study's; name a new folder", root.string(), name));
        }
    }
}

PlannedSolve StudyScene::plan(const SolveCommand& command)
{
    input.scene.views = views;
    return plan_solve(command, input, caster);
}

StudyPlanner::StudyPlanner(std::string file)
{
    ReadStudy read = read_study_file(file);
    study_ = std::move(read.study);
    sha256_ = sha256_hex(read.text);
    cells_ = expand(study_);
    if (const OptionText* seed = find(study_.options, "seed")) {
        std::from_chars(seed->value.data(), seed->value.data() + seed->value.size(), seed_);
    }
}

SolveCommand StudyPlanner::command_of(const StudyCell& cell) const
{
    std::vector<OptionText> options = cell.options;
    if (!study_.limits.memory.empty() && find(options, "memory") == nullptr) {
        options.push_back({"memory", study_.limits.memory, study_.limits.memory_place});
    }
    return solve_command_of(cell.scene, "run", options, study_.file);
}

SolveCommand StudyPlanner::reference_command_of(const StudyCell& cell) const
{
    std::vector<OptionText> options = reference_options(study_);
    std::erase_if(options,
                  [](const OptionText& o) { return std::ranges::find(scene_options, o.name) != scene_options.end(); });
    for (const OptionText& option : cell.options) {
        if (std::ranges::find(scene_options, option.name) != scene_options.end()) options.push_back(option);
    }
    return solve_command_of(cell.scene, "run", options, study_.file);
}

StudyScene& StudyPlanner::scene_of(const StudyCell& cell)
{
    const SceneArguments arguments = command_of(cell).scene;
    const std::string key = arguments.file + '\n' + json_of(arguments.options).dump();
    if (key != scene_key_) {
        scene_key_.clear();
        scene_ = std::make_unique<StudyScene>(arguments);
        scene_key_ = key;
    }
    return *scene_;
}

PlannedSolve StudyPlanner::solve_of(const StudyCell& cell)
{
    return scene_of(cell).plan(command_of(cell));
}

PlannedReference StudyPlanner::reference_of(const StudyCell& cell)
{
    StudyScene& scene = scene_of(cell);
    if (!scene.reference) scene.reference = find_reference(cell, scene);
    return *scene.reference;
}

PlannedReference StudyPlanner::find_reference(const StudyCell& cell, StudyScene& scene)
{
    PlannedReference planned;
    Json source;
    switch (study_.reference.kind) {
    case ReferenceKind::none:
        return planned;
    case ReferenceKind::solution:
        planned.solve = reference_command_of(cell);
        source = run_id(scene.plan(*planned.solve).identity);
        break;
    case ReferenceKind::run:
        source = record_of(open_run(study_.reference.file), {}).solution_sha256;
        break;
    case ReferenceKind::points:
        source = digest_of_file(study_.reference.file);
        break;
    case ReferenceKind::path_traced:
    case ReferenceKind::furnace:
        break;
    }
    planned.key = reference_key(study_.reference, scene.input.scene, seed_, source);
    if (!study_.reference.seen_from.empty())
        planned.key["seen_from"] = json_of(chosen_view(study_.reference.seen_from, scene.input.scene, scene.caster));
    planned.id = content_id(planned.key);
    return planned;
}

StudyPlan StudyPlanner::plan()
{
    StudyPlan plan{study_, sha256_, seed_, {}};
    std::exception_ptr first;
    bool any = false;
    for (const StudyCell& cell : cells_) {
        PlannedCell planned;
        planned.cell = cell;
        try {
            planned.id = run_id(solve_of(cell).identity);
            planned.reference = reference_of(cell).id;
            any = true;
        } catch (const std::runtime_error& problem) {
            planned.id.clear();
            planned.problem = problem.what();
            if (!first) first = std::current_exception();
        }
        plan.cells.push_back(std::move(planned));
    }
    if (!any && first) std::rethrow_exception(first);
    return plan;
}

}  // namespace patchlight
