#pragma once

#include "apps/patchlight/commands.h"
#include "apps/patchlight/cost_estimate.h"
#include "apps/study/study.h"

#include <vector>

namespace patchlight {

/// A cell as it would be run.
struct EstimatedCell {
    StudyCell cell;
    CostEstimate cost;
};

/// All that a study would run.
struct StudyEstimate {
    std::vector<EstimatedCell> cells;
    CostEstimate reference;  ///< of all scenes
};

/// Expands a study and estimates it, without writing anything. Each scene is read once for each way in which options
/// have it read. Throws what running the study would: StudyError, StudyLimitError, UsageError, SceneError, LimitError.
StudyEstimate estimate_of(const Study& study, const Session& session);

}  // namespace patchlight
