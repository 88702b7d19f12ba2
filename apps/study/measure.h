#pragma once

#include "apps/run/probing.h"
#include "apps/run/run_folder.h"
#include "apps/study/reference.h"
#include "apps/study/study_result.h"

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace patchlight {

/// What a cell is held to, and what is asked of it.
struct Measures {
    std::string reference;                                ///< its folder's name; empty: none
    const std::vector<ReferencePoint>* points = nullptr;  ///< null: no reference, or one that isn't done
    std::vector<ProbePoint> probes;
    std::string probes_sha256;  ///< of their file
    std::uint64_t seed = 1;     ///< of intervals
};

/// A cycle's error against a reference. The reference's own variance is not counted as error in `error`; `max_error`
/// has it, where the reference is sampled.
struct CycleError {
    std::optional<double> error, max_error;  ///< unset where the reference is dark and the solution isn't
    std::optional<Interval> error_ci;
};
CycleError error_against(const std::vector<ReferencePoint>& reference, const StoredSolution& solution,
                         std::uint64_t seed);

/// What was measured of a run.
struct Measured {
    std::vector<CycleError> cycles;  ///< in the run's order; empty without a reference
    std::vector<std::optional<Rgb>> probes;
};

/// All cycles of a run, and its last at the probes. Kept in `cache`, and taken from there when run, reference and
/// probes are those it was made of; `writer` null: nothing is written. Throws SceneError for a broken run, Interrupted.
Measured measured(const OpenedRun& run, const Measures& measures, const std::filesystem::path& cache,
                  FileWriter* writer, const std::stop_token& stop);

}  // namespace patchlight
