#include "apps/study/check_study.h"

#include <algorithm>

namespace patchlight {

namespace {

/// The folders below `group` that hold a run, themselves or in their folder "run".
void add_runs(const std::filesystem::path& group, std::vector<std::filesystem::path>& runs)
{
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(group, error))
        for (const std::filesystem::path& run : {entry.path(), entry.path() / "run"})
            if (std::filesystem::exists(run / "run.json", error)) runs.push_back(run);
}

}  // namespace

bool is_study_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    return std::filesystem::is_directory(folder / "cells", error) &&
           !std::filesystem::exists(folder / "run.json", error);
}

StudyCheck check_study(const StudyFolder& folder)
{
    StudyCheck check;
    add_runs(folder.root / "cells", check.runs);
    add_runs(folder.root / "references", check.runs);
    std::ranges::sort(check.runs);
    for (const std::filesystem::path& path : check.runs) {
        const std::filesystem::path own = path.lexically_relative(folder.root);
        try {
            const OpenedRun run = open_run(path);
            check.files += run.record.files.size();
            for (const FileProblem& problem : check_files(run))
                check.problems.push_back({(own / problem.file).string(), problem.cause});
        } catch (const std::exception& problem) {
            check.problems.push_back({(own / "run.json").string(), problem.what()});
        }
    }
    return check;
}

}  // namespace patchlight
