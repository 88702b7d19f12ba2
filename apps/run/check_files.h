#pragma once

#include "apps/run/run_folder.h"

#include <string>
#include <vector>

namespace patchlight {

/// A file of a run that isn't what was written.
struct FileProblem {
    std::string file;   ///< its path in the run's folder
    std::string cause;  ///< "is missing", …
};

/// Reads every file that run.json and the cycles' records name by its SHA-256, and compares; sorted by name. Tells what
/// has changed since the run wrote it by accident: whoever changes run.json, too, isn't found out. Of an unfinished
/// run: what is there so far. Never leaves the run's folder, whatever run.json names; throws nothing.
std::vector<FileProblem> check_files(const OpenedRun& run);

/// Where two runs were to be the same to the byte: the files that aren't, by their recorded digests, and run.json where
/// it differs in more than which program wrote it and these digests. Throws std::runtime_error when a run.json can't be
/// read.
std::vector<FileProblem> differing_files(const OpenedRun& run, const OpenedRun& other);

}  // namespace patchlight
