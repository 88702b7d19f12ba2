#pragma once

#include "apps/patchlight/planned_solve.h"
#include "apps/study/collect.h"
#include "apps/study/reference.h"

#include <memory>
#include <optional>
#include <string>

namespace patchlight {

/// Where a study's reference stands, and what it takes.
struct PlannedReference {
    std::string id;  ///< its folder; empty: there is none
    Json key;
    std::optional<SolveCommand> solve;  ///< ReferenceKind::solution: without its run's folder
};

/// A scene as cells ask for it.
struct StudyScene {
    explicit StudyScene(const SceneArguments& arguments)
        : input(load_scene(arguments)), caster(input.scene), views(input.scene.views)
    {}

    /// As plan_solve(); `input` has the views of this solve afterwards.
    PlannedSolve plan(const SolveCommand& command);

    SceneInput input;
    RayCaster caster;
    std::vector<View> views;                    ///< the scene's own
    std::optional<PlannedReference> reference;  ///< once it has been asked for
};

/// Finds out where cells and references of a study stand. Keeps the scene that was read last: cells that share one and
/// follow each other read it once.
class StudyPlanner {
public:
    /// Throws StudyError, and what expand() throws.
    StudyPlanner(std::string file);

    const Study& study() const { return study_; }
    const std::vector<StudyCell>& cells() const { return cells_; }
    std::uint64_t seed() const { return seed_; }

    /// The solve of a cell, without its run's folder. Throws UsageError, SceneError, FolderRefused.
    PlannedSolve solve_of(const StudyCell& cell);
    /// The reference that a cell is held to. Throws as solve_of(), PointsError.
    PlannedReference reference_of(const StudyCell& cell);
    /// The scene of a cell, until another is asked for.
    StudyScene& scene_of(const StudyCell& cell);

    /// All cells. One that can't be run carries its problem; when that goes for all, the first problem is thrown.
    StudyPlan plan();

private:
    SolveCommand command_of(const StudyCell& cell) const;
    SolveCommand reference_command_of(const StudyCell& cell) const;
    PlannedReference find_reference(const StudyCell& cell, StudyScene& scene);

    Study study_;
    std::string sha256_;
    std::vector<StudyCell> cells_;
    std::uint64_t seed_ = 1;
    std::string scene_key_;
    std::unique_ptr<StudyScene> scene_;
};

/// What names a run's folder: scene, effective options and how the program computes.
std::string run_id(const RunIdentity& identity);

/// The folder of a study: `given`, or the study file's name with "-study" behind it in the working directory.
StudyFolder study_folder(const std::string& study_file, const std::string& given);

/// Throws FolderRefused when the folder is a file, or holds what isn't a study's.
void refuse_foreign(const StudyFolder& folder);

}  // namespace patchlight
