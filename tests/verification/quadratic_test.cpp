// Quadratic elements on the narrow penumbra of reference-values.md §5, on the mesh that linear ones ask for.
#include "tests/verification/shadow_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace patchlight {
namespace {

using verification::shadow_case;
using verification::SolvedShadow;

TEST(QuadraticElements, ReachMoreOnTheSameMeshThanLinearOnes)
{
    const SolvedShadow narrow(shadow_case("narrow"));
    std::printf("elements | linear   | quadratic\n");
    std::vector<double> count, error;
    for (const std::size_t n : {1024UL, 2048UL, 4096UL, 8192UL, 16384UL}) {
        const AdaptiveSolution solution = narrow.solve(Refine::both, n, Elements::quadratic);
        const double linear = narrow.error(solution, Elements::linear), quadratic = narrow.error(solution, Elements::quadratic);
        count.push_back(static_cast<double>(narrow.count(solution)));
        error.push_back(quadratic);
        std::printf("%8.0f | %.2e | %.2e\n", count.back(), linear, quadratic);
        if (n == 4096) {
            EXPECT_LT(quadratic, 0.2 * linear);
        }
    }
    const double rate = std::log(error.front() / error.back()) / std::log(count.back() / count.front());
    std::printf("rate between 1k and 16k: %.2f\n", rate);
    EXPECT_GE(rate, 1.3);
}

}  // namespace
}  // namespace patchlight
