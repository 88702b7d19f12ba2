#pragma once

#include "formfactor/random_numbers.h"
#include "solver/system.h"

namespace patchlight {

/// Ray i of a batch: from a uniformly random place of a patch, cosine-weighted [Malley88], without an end.
void set_random_ray(const Exchange& exchange, PatchId patch, RandomNumbers& random, std::size_t i, RayBatch& batch);

}  // namespace patchlight
