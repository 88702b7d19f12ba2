#pragma once

#include "apps/run/run_folder.h"

#include <filesystem>
#include <optional>
#include <string>

namespace patchlight {

/// A run and one of its cycles, as RUN, RUN@N, RUN@first or RUN@last name it.
struct ChosenRun {
    OpenedRun run;
    WhichCycle cycle;
    std::string name;  ///< as it was given
};

/// A folder whose own name holds an @ is that folder. Throws as open_run and record_of, UsageError for what stands
/// behind the @.
ChosenRun chosen_run(const std::string& text);

/// Seconds from the run's start to the end of a cycle, pictures left out; nothing where timing.json doesn't say.
std::optional<double> seconds_until(const OpenedRun& run, const CycleRecord& cycle);

}  // namespace patchlight
