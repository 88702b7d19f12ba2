#pragma once

#include "apps/run/stored_solution.h"
#include "apps/verification/verify.h"

#include <vector>

namespace patchlight {

/// What a stored solution shows at points of its surfaces, as probing does: the reflected part B − E, and the patches'
/// estimates √(η²/A). 0 where the mesh has no patch.
std::vector<ShownPoint> shown_at(const StoredSolution& stored, const std::vector<DrawnPoint>& points);

}  // namespace patchlight
