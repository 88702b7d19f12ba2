#pragma once

#include "apps/verification/measured_error.h"
#include "apps/verification/path_tracer.h"
#include "formfactor/work_monitor.h"

#include <functional>
#include <optional>
#include <vector>

namespace patchlight {

struct VerifyOptions {
    std::size_t points = 2000;        ///< over all reflecting surface, ≥ 1
    std::uint32_t most_paths = 4096;  ///< from each point; rounded up to a multiple of 8
    std::uint64_t seed = 1;
    std::optional<FindEmitters> emitters;  ///< unset: as PathTracer chooses
};

/// What a solution shows at a point.
struct ShownPoint {
    Rgb reflected{0.0};    ///< B − E, W/m²
    double estimated = 0;  ///< its own estimate of its error there, W/m²
};
using ShownLight = std::function<ShownPoint(const DrawnPoint&)>;

struct Verification {
    std::vector<MeasuredPoint> points;
    MeasuredError error;
    std::uint32_t paths = 0;  ///< from each point
    std::size_t rays = 0;
};

/// Measures the error of a solution by paths from area-uniform points of all reflecting surface. Paths are doubled,
/// from 128 a point, until the interval of l2 is within a tenth of l2 on both sides, or owes less than a tenth of
/// its variance to the paths' noise, or there are most_paths. The answer depends on the scene, what is shown, the
/// points, most_paths and the seed: not on threads or time. No reflecting surface or no emitter: no error. `shown` is
/// called from one thread. Throws Interrupted.
Verification verify_light(const Scene& scene, const RayCaster& caster, const ShownLight& shown,
                          const VerifyOptions& options, const WorkMonitor& monitor = {});

}  // namespace patchlight
