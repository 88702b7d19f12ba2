#pragma once

#include "meshing/fields.h"
#include "meshing/refinement.h"

#include <string_view>

namespace patchlight {

enum class Indicator {
    residual,          ///< B gathered anew at extra points of the patch against the linear solution there
    vertex_difference  ///< the lecture's: how much B differs between a patch's corners
};

struct EstimateOptions {
    Indicator indicator = Indicator::residual;
};

/// Per patch, ≥ 0. It is an indicator, not a bound.
struct ErrorEstimate {
    PatchField<double> eta;  ///< √∫|B̃ − B|² dA over the patch, W/m²·m, three bands together
    double total = 0;        ///< √Σ η²
    double relative = 0;     ///< total / √∫|B − E|² dA over all reflecting surface; 0/0 = 0
};

enum class Marking {
    doerfler,        ///< the fewest patches that hold a share of Σ η²
    fixed_fraction  ///< the worst share of the patches
};

struct MarkOptions {
    Marking marking = Marking::doerfler;
    double share = 0.7;  ///< of Σ η² (doerfler) or of the patches (fixed_fraction), in (0, 1]
};

}  // namespace patchlight
