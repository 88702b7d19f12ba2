#pragma once

#include "apps/report/study_page.h"

namespace patchlight {

/// Whether `study run` has left its results in a folder.
bool is_stored_study(const StudyFolder& folder);

/// What they were when it ended last: of study.toml, study.json, timing.json and pictures/, without the scenes or the
/// study file that it was run from. Throws StudyError when study.toml isn't a study, SceneError ("study") when
/// study.json isn't that study's; without the other files only seconds and pictures are missing.
ShownStudy stored_study(const StudyFolder& folder);

}  // namespace patchlight
