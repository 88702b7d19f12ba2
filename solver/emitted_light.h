#pragma once

#include "formfactor/source.h"
#include "solver/gather.h"

#include <vector>

namespace patchlight {

enum class Direct {
    exact,   ///< emitters clipped by what hides them, Lambert's formula; no noise
    sampled  ///< Lambert's formula times the part that shadow rays find visible
};

/// The emitters' light at points, apart from all other: exact where Exchange has that, else by shadow rays to
/// `sources`; with neither, rays that meet emitters bring it, and it isn't apart.
struct EmittedLight {
    std::vector<Source> sources;  ///< for shadow rays

    bool is_apart(const Exchange& exchange) const { return exchange.direct != nullptr || !sources.empty(); }

    /// W/m² at each point, 0 where nothing is reflected; shadow rays as `options` say. Throws Interrupted.
    GatheredLight at(const Exchange& exchange, std::span<const SurfacePoint> points, const GatherOptions& options,
                     const WorkMonitor& monitor = {}) const;
};

}  // namespace patchlight
