#pragma once

#include "apps/verification/measured_error.h"
#include "apps/verification/path_tracer.h"
#include "formfactor/work_monitor.h"

#include <optional>
#include <vector>

namespace patchlight {

struct VerifyOptions {
    std::size_t points = 2000;        ///< over all reflecting surface, ≥ 1
    std::uint32_t most_paths = 4096;  ///< from each point; rounded up to a multiple of 8
    std::uint64_t seed = 1;
    std::optional<FindEmitters> emitters;  ///< unset: as PathTracer chooses
};

/// The points that the options ask for; none where nothing reflects.
std::vector<DrawnPoint> points_to_verify(const Scene& scene, const VerifyOptions& options);

/// What a solution shows at a point.
struct ShownPoint {
    Rgb reflected{0.0};    ///< B − E, W/m²
    double estimated = 0;  ///< its own estimate of its error there, W/m²
};

/// A solution beside the light that was found.
struct VerifiedSolution {
    std::vector<MeasuredPoint> points;
    MeasuredError error;
};

struct Verification {
    std::vector<VerifiedSolution> solutions;
    std::uint32_t paths = 0;  ///< from each point
    std::size_t rays = 0;
};

/// Measures the errors of solutions (what each shows at each of the points) by the same paths from the points. Paths
/// are doubled, from 128 a point, until each interval of l2 is within a tenth of l2 on both sides, or owes less than a
/// tenth of its variance to the paths' noise, or there are most_paths. The answer depends on the scene, the points,
/// what is shown there, most_paths and the seed: not on threads or time. No point or no emitter: no error. Throws
/// Interrupted.
Verification verify_light(const Scene& scene, const RayCaster& caster, const std::vector<DrawnPoint>& points,
                          const std::vector<std::vector<ShownPoint>>& solutions, const VerifyOptions& options,
                          const WorkMonitor& monitor = {});

}  // namespace patchlight
