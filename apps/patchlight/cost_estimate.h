#pragma once

#include "meshing/scene.h"
#include "solver/adaptive.h"

#include <cstddef>

namespace patchlight {

/// What a solve will roughly need. Orders of magnitude.
struct CostEstimate {
    std::size_t elements = 0;  ///< of the largest mesh
    double rays = 0;           ///< of all cycles
    double bytes = 0;          ///< at the largest
};

CostEstimate estimate_cost(const Scene& scene, const AdaptiveOptions& options);

/// Throws LimitError when the machine's memory is too small for a solve.
void check_memory(const Scene& scene, const AdaptiveOptions& options);

}  // namespace patchlight
