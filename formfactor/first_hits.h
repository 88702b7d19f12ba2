#pragma once

#include "formfactor/ray_caster.h"

#include <cstdint>

namespace patchlight {

/// What rays from the fronts meet first, as shares: of all rays (area- and cosine-weighted over all surfaces),
/// and of the emitted power.
struct FirstHits {
    double backs = 0;            ///< of all rays: a black back (mixed winding shows here)
    double escaped = 0;          ///< of all rays: nothing
    double emitted_backs = 0;    ///< of the emitted power: a black back
    double emitted_escaped = 0;  ///< of the emitted power: nothing (a flipped emitter shows here)
};

/// Covered points, whose every ray meets a back, are left out. Traces about `rays` rays from all surfaces and as many
/// from the emitters.
FirstHits sample_first_hits(const Scene& scene, const RayCaster& caster, int rays = 65536, std::uint64_t seed = 1);

}  // namespace patchlight
