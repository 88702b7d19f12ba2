#pragma once

#include "formfactor/work_monitor.h"  // Interrupted

#include <cstddef>
#include <functional>
#include <string_view>

namespace patchlight {

/// Where a long computation stands.
struct Progress {
    std::string_view stage;  ///< direct, lines, assemble, solve, importance, indirect, estimate, gather, mesh
    int cycle = 0;           ///< -1 = there are none
    double fraction = 0;     ///< of this stage, 0 … 1; never falls
    std::size_t elements = 0;
    std::size_t rays = 0;  ///< traced so far in this stage
    double unshot = -1;    ///< share of the emitted power not yet shot; -1 = does not apply
    double residual = -1;  ///< of the linear solve; -1 = does not apply
};

/// Called from one thread at a time, some times a second.
using ProgressObserver = std::function<void(const Progress&)>;

}  // namespace patchlight
