#include "apps/verification/found_light.h"

namespace patchlight {

std::size_t add_paths(const PathTracer& tracer, const std::vector<DrawnPoint>& points, const PathsFrom& which,
                      const WorkMonitor& monitor, std::vector<PathSums>& sums)
{
    const auto work = [&](std::size_t k, PathTracer::Scratch& scratch) {
        const std::size_t i = which.first_point + k;
        for (std::uint32_t stream = 0; stream < path_streams; ++stream)
            tracer.add_paths(points[i], i * path_streams + stream, which.first, which.count, sums[i][stream], scratch);
    };
    return for_each_row<PathTracer::Scratch>(which.points, monitor, work, 4);
}

FoundLight found_by(const PathSums& sums, std::uint32_t paths)
{
    FoundLight found;
    for (const Rgb& sum : sums) found.mean += sum / static_cast<double>(paths * path_streams);
    for (const Rgb& sum : sums) {
        const Rgb d = sum / static_cast<double>(paths) - found.mean;
        found.variance += d * d / static_cast<double>(path_streams * (path_streams - 1));
    }
    return found;
}

}  // namespace patchlight
