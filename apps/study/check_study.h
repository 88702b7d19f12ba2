#pragma once

#include "apps/run/check_files.h"
#include "apps/study/study_folder.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace patchlight {

/// Whether a folder holds a study's cells.
bool is_study_folder(const std::filesystem::path& folder);

/// What became of the files of a study's runs.
struct StudyCheck {
    std::vector<std::filesystem::path> runs;  ///< of cells and references, sorted; those that were begun
    std::size_t files = 0;                    ///< that they name
    std::vector<FileProblem> problems;        ///< by their paths in the study's folder
};

/// As check_files() for every run in the folder; one whose run.json can't be read is a problem, too. Throws nothing.
StudyCheck check_study(const StudyFolder& folder);

}  // namespace patchlight
