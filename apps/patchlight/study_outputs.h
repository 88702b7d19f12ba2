#pragma once

#include "apps/patchlight/commands.h"
#include "apps/study/study_folder.h"

#include <cstddef>

namespace patchlight {

/// Writes what stands beside study.json: table.md, table.csv and pictures/, the same bytes for the same results. Throws
/// OutputError, SceneError when a stored solution is broken, Interrupted.
void write_study_outputs(const StudyPictures& pictures, const StudyResult& study, const StudyFolder& folder,
                         Session& session);

/// Names every gate that failed. Returns how many did.
std::size_t name_failed_gates(const StudyResult& study, const Session& session);

}  // namespace patchlight
