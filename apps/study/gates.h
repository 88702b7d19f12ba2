#pragma once

#include "apps/study/rates.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// What became of one gate at one cell or series.
struct GateResult {
    std::string gate;             ///< as the study file has it: "min_rate"
    std::string of;               ///< the cell or the series
    std::optional<double> value;  ///< unset: it couldn't be checked, which counts as failed; `message` says why
    double bound = 0;
    bool passed = false;
    std::string message;
};

/// Every gate of the study at every cell (at every series: min_rate). Errors are measured ones: estimates don't pass
/// gates. Effectivity is estimated over measured error, 0/0 = 1.
std::vector<GateResult> check_gates(const StudyResult& study);

}  // namespace patchlight
