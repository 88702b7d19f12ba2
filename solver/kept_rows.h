#pragma once

#include "formfactor/form_factors.h"

#include <cstddef>

namespace patchlight {

/// What a solve with Refine::none traces, kept: with other ρ and E on the same mesh the same rows hold. They depend on
/// geometry, mesh, options, and which surfaces reflect and emit, not on how much. Empty: not known.
struct KeptRows {
    FormFactorMatrix patches;   ///< F
    FormFactorMatrix estimate;  ///< of the points where the error is estimated
    FormFactorMatrix nodes;     ///< of the nodes of the solution

    std::size_t rays() const { return patches.rays + estimate.rays + nodes.rays; }
};

}  // namespace patchlight
