#include "apps/verification/verify.h"

#include "apps/verification/found_light.h"

#include <algorithm>

namespace patchlight {

namespace {

constexpr std::uint32_t first_round = 16;  // paths of a stream

bool well_known(const MeasuredError& error)
{
    const double half = std::max(error.l2 - error.l2_ci.low, error.l2_ci.high - error.l2);
    return half <= 0.1 * error.l2 || error.from_paths < 0.1;
}

/// Whether all are.
bool measure(const std::vector<PathSums>& sums, std::uint32_t paths, std::uint64_t seed,
             std::vector<VerifiedSolution>& solutions)
{
    bool enough = true;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const FoundLight found = found_by(sums[i], paths);
        for (VerifiedSolution& solution : solutions) {
            solution.points[i].found = found.mean;
            solution.points[i].variance = found.variance;
        }
    }
    for (VerifiedSolution& solution : solutions) {
        solution.error = measured_error(solution.points, seed);
        enough = enough && well_known(solution.error);
    }
    return enough;
}

VerifiedSolution unmeasured(const std::vector<DrawnPoint>& points, const std::vector<ShownPoint>& shown)
{
    VerifiedSolution solution;
    for (std::size_t i = 0; i < points.size(); ++i)
        solution.points.push_back({points[i].surface, shown[i].reflected, shown[i].estimated, Rgb(0.0), Rgb(0.0)});
    return solution;
}

constexpr std::uint64_t for_points = 0, for_paths = 1, for_intervals = 2;

std::uint64_t seed_of(const VerifyOptions& options, std::uint64_t purpose)
{
    return RandomNumbers(options.seed, purpose).bits();
}

}  // namespace

std::vector<DrawnPoint> points_to_verify(const Scene& scene, const VerifyOptions& options)
{
    return draw_points(reflecting_surface(scene), options.points, seed_of(options, for_points));
}

Verification verify_light(const Scene& scene, const RayCaster& caster, const std::vector<DrawnPoint>& points,
                          const std::vector<std::vector<ShownPoint>>& solutions, const VerifyOptions& options,
                          const WorkMonitor& monitor)
{
    Verification result;
    for (const auto& shown : solutions) result.solutions.push_back(unmeasured(points, shown));
    const PathTracer tracer(scene, caster, seed_of(options, for_paths), options.emitters);
    const std::uint32_t most = std::max(1U, (options.most_paths + path_streams - 1) / path_streams);
    std::vector<PathSums> sums(points.size());
    for (PathSums& of_point : sums) of_point.fill(Rgb(0.0));
    for (std::uint32_t done = 0; done < most && !points.empty();) {
        const std::uint32_t next = std::min(most, std::max(first_round, 2 * done));
        WorkMonitor round{monitor.stop, {}};
        if (monitor.tell)
            round.tell = [&](const WorkState& state) {
                monitor.tell({(done + state.fraction * (next - done)) / most, result.rays + state.rays});
            };
        result.rays += add_paths(tracer, points, {0, points.size(), done, next - done}, round, sums);
        done = next;
        result.paths = done * path_streams;
        if (measure(sums, done, seed_of(options, for_intervals), result.solutions)) break;
    }
    return result;
}

}  // namespace patchlight
