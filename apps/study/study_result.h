#pragma once

#include "apps/study/study.h"
#include "apps/verification/measured_error.h"
#include "meshing/vectors.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// What one cycle of a cell came to.
struct CycleResult {
    int cycle = 0;
    std::size_t elements = 0;
    std::size_t rays = 0;  ///< so far
    double estimated_error = 0;
    std::optional<double> error;       ///< against the reference, relative L2; unset without one
    std::optional<Interval> error_ci;  ///< of 95 %
    std::optional<double> max_error;   ///< greatest |shown − B| of the points over √mean |B|²
    double energy_residual = 0;
    double seconds = 0;  ///< wall, so far; from the clock: in no file but timing.json
};

enum class CellStatus {
    waiting,        ///< not begun
    unfinished,     ///< interrupted, or running
    over_time,      ///< stopped by the study's limit
    failed,         ///< `message` says why
    not_converged,  ///< ran to its end and missed its tolerance or target
    done
};

std::string name_of(CellStatus status);

/// A cell and what it came to.
struct CellResult {
    StudyCell cell;
    std::string id;  ///< its folder: DIR/cells/ID
    CellStatus status = CellStatus::waiting;
    std::string message;
    std::vector<CycleResult> cycles;
    double peak_memory = 0;  ///< bytes, of the process that ended it; 0: not known. As seconds: in timing.json alone
    std::vector<std::optional<Rgb>> probes;  ///< B at the study's points; W/m²
};

/// Everything a study came to: what tables, gates and the page are made of.
struct StudyResult {
    std::string name;
    std::vector<StudyAxis> axes;
    std::string along;
    StudyGates gates;
    std::vector<StudyComparison> comparisons;
    StudyReference reference;
    std::vector<CellResult> cells;
};

}  // namespace patchlight
