#include "apps/verification/verify.h"

#include <algorithm>
#include <array>

namespace patchlight {

namespace {

/// Independent streams of paths a point: their spread gives the variance.
constexpr std::uint32_t streams = 8;
constexpr std::uint32_t first_round = 16;  // paths of a stream

using Sums = std::array<Rgb, streams>;

/// Paths first … first + count − 1 of every stream of every point.
std::size_t trace(const PathTracer& tracer, const std::vector<DrawnPoint>& points, std::uint32_t first,
                  std::uint32_t count, const WorkMonitor& monitor, std::vector<Sums>& sums)
{
    const auto work = [&](std::size_t i, PathTracer::Scratch& scratch) {
        for (std::uint32_t k = 0; k < streams; ++k)
            tracer.add_paths(points[i], i * streams + k, first, count, sums[i][k], scratch);
    };
    return for_each_row<PathTracer::Scratch>(points.size(), monitor, work, 4);
}

/// Mean and variance of the mean of the streams.
void conclude(const std::vector<Sums>& sums, std::uint32_t paths, std::vector<MeasuredPoint>& points)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        Rgb mean(0.0), squares(0.0);
        for (const Rgb& sum : sums[i]) mean += sum / static_cast<double>(paths * streams);
        for (const Rgb& sum : sums[i]) {
            const Rgb d = sum / static_cast<double>(paths) - mean;
            squares += d * d;
        }
        points[i].found = mean;
        points[i].variance = squares / static_cast<double>(streams * (streams - 1));
    }
}

bool well_known(const MeasuredError& error)
{
    const double half = std::max(error.l2 - error.l2_ci.low, error.l2_ci.high - error.l2);
    return half <= 0.1 * error.l2 || error.from_paths < 0.1;
}

}  // namespace

Verification verify_light(const Scene& scene, const RayCaster& caster, const ShownLight& shown,
                          const VerifyOptions& options, const WorkMonitor& monitor)
{
    RandomNumbers seeds(options.seed, 0);
    const std::uint64_t for_points = seeds.bits(), for_paths = seeds.bits(), for_intervals = seeds.bits();
    const std::vector<DrawnPoint> points = draw_points(reflecting_surface(scene), options.points, for_points);
    Verification result;
    for (const DrawnPoint& point : points) {
        const ShownPoint seen = shown(point);
        result.points.push_back({point.surface, seen.reflected, seen.estimated, Rgb(0.0), Rgb(0.0)});
    }
    const PathTracer tracer(scene, caster, for_paths, options.emitters);
    const std::uint32_t most = std::max(1U, (options.most_paths + streams - 1) / streams);
    std::vector<Sums> sums(points.size());
    for (Sums& of_point : sums) of_point.fill(Rgb(0.0));
    for (std::uint32_t done = 0; done < most && !points.empty();) {
        const std::uint32_t next = std::min(most, std::max(first_round, 2 * done));
        WorkMonitor round{monitor.stop, {}};
        if (monitor.tell)
            round.tell = [&](const WorkState& state) {
                monitor.tell({(done + state.fraction * (next - done)) / most, result.rays + state.rays});
            };
        result.rays += trace(tracer, points, done, next - done, round, sums);
        done = next;
        result.paths = done * streams;
        conclude(sums, done, result.points);
        result.error = measured_error(result.points, for_intervals);
        if (well_known(result.error)) break;
    }
    return result;
}

}  // namespace patchlight
