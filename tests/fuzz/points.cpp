#include "apps/run/probing.h"
#include "tests/fuzz/made_run.h"
#include "tests/fuzz/target.h"

#include <cmath>
#include <stdexcept>

using namespace patchlight;

/// A CSV of points, probed on a small solution: what is answered is finite and not below 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const StoredSolution solution = decode_solution(testing::made_run().cycles.back(), "made");
    static const SurfaceProbe probe(solution);
    std::vector<ProbePoint> points;
    try {
        points = read_points(testing::text_of(data, size), "fuzzed.csv");
    } catch (const PointsError&) {
        return 0;
    }
    const auto answers = probe.at(points);
    for (const auto& answer : answers) {
        if (answer && !(std::isfinite(answer->B.r) && answer->B.r >= 0))
            throw std::logic_error("an answer isn't finite, or below 0");
    }
    probe_csv(points, answers);
    return 0;
}
