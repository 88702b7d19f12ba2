#pragma once

#include "apps/verification/path_tracer.h"
#include "formfactor/work_monitor.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// Independent streams of paths a point: their spread gives the variance.
inline constexpr std::uint32_t path_streams = 8;

/// What a point's streams have found, each the sum of its paths.
using PathSums = std::array<Rgb, path_streams>;

/// Paths of every stream of some points.
struct PathsFrom {
    std::size_t first_point = 0, points = 0;
    std::uint32_t first = 0, count = 0;  ///< of each stream
};

/// Traces them and adds what they find to sums[point]: as many as `points`. Depends on point and path alone, not on
/// the other points or threads. Returns the rays. Throws Interrupted.
std::size_t add_paths(const PathTracer& tracer, const std::vector<DrawnPoint>& points, const PathsFrom& which,
                      const WorkMonitor& monitor, std::vector<PathSums>& sums);

/// An unbiased estimate of the reflected part B − E at a point, W/m².
struct FoundLight {
    Rgb mean{0.0}, variance{0.0};  ///< of the mean, (W/m²)²
};

/// From so many paths of each stream.
FoundLight found_by(const PathSums& sums, std::uint32_t paths);

}  // namespace patchlight
