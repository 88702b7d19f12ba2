// Whole verifications of solutions whose error is known.
#include "apps/verification/verify.h"

#include "tests/meshing/written_scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace patchlight {
namespace {

Scene furnace()
{
    return read_scene(PATCHLIGHT_DATA "/scenes/furnace.obj").scene;
}

/// Verifies a solution that shows the same everywhere.
struct Verified : VerifiedSolution {
    std::uint32_t paths = 0;
    std::size_t rays = 0;
};

Verified verify(const Scene& scene, const Rgb& shown, const VerifyOptions& options = {},
                const WorkMonitor& monitor = {})
{
    const auto points = points_to_verify(scene, options);
    const std::vector<ShownPoint> everywhere(points.size(), ShownPoint{shown, 0.01});
    const Verification v = verify_light(scene, RayCaster(scene), points, {everywhere}, options, monitor);
    return {v.solutions.front(), v.paths, v.rays};
}

/// B − E of the furnace.
Rgb furnace_light(const Scene& scene)
{
    const Material& m = scene.materials.front();
    return m.reflectance * m.emission / (1.0 - m.reflectance);
}

TEST(Verify, MeasuresAKnownPerturbationOfTheFurnace)
{
    const Scene scene = furnace();
    int held = 0;
    constexpr int runs = 10;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        const MeasuredError error = verify(scene, 1.02 * furnace_light(scene), {300, 1024, seed, {}}).error;
        held += error.l2_ci.low <= 0.02 && 0.02 <= error.l2_ci.high ? 1 : 0;
        // A path's standard deviation is √ρ of the value: 2.6 % a point, squared and halved by 300 points to 5e-5 of
        // .02².
        EXPECT_NEAR(error.l2, 0.02, 0.006);
    }
    EXPECT_GE(held, 7) << "nine or ten expected; fewer than 7 would happen in one of 1,000";
}

TEST(Verify, AnExactSolutionHasNoError)
{
    const Scene scene = furnace();
    const Verified exact = verify(scene, furnace_light(scene), {500, 1024, 7, {}});
    EXPECT_EQ(exact.error.l2_ci.low, 0);
    EXPECT_LT(exact.error.l2_ci.high, 0.5 * exact.error.l2_noise) << "the noise is not counted as error";
    EXPECT_EQ(exact.paths, 1024U) << "no error is known well enough: all paths are used";
    EXPECT_EQ(exact.points.size(), 500U);
}

TEST(Verify, TakesFewPathsWhereTheErrorIsLarge)
{
    const Scene scene = furnace();
    const Verified wrong = verify(scene, 2.0 * furnace_light(scene), {500, 4096, 7, {}});
    EXPECT_EQ(wrong.paths, 128U);
    EXPECT_NEAR(wrong.error.l2, 1, 0.05);
}

TEST(Verify, IsTheSameOnAnyNumberOfThreads)
{
    const Scene scene = testing::load(testing::room_with_lamp()).scene;
    const auto found = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return verify(scene, Rgb(1.0), {200, 256, 3, {}});
    };
    const Verified one = found(1), many = found(4);
    EXPECT_EQ(one.error.l2, many.error.l2);
    EXPECT_EQ(one.error.l2_ci.low, many.error.l2_ci.low);
    EXPECT_EQ(one.rays, many.rays);
    for (std::size_t i = 0; i < one.points.size(); ++i) {
        EXPECT_EQ(one.points[i].found, many.points[i].found);
        EXPECT_EQ(one.points[i].variance, many.points[i].variance);
    }
}

TEST(Verify, WithoutLightOrReflectionThereIsNoError)
{
    SceneOptions options;
    options.require_emitter = false;
    const Scene dark = testing::load(testing::box({0, 0, 0}, {1, 1, 1}, true), options).scene;
    EXPECT_EQ(verify(dark, Rgb(0.0)).error.l2, 0);
    const Scene black = testing::read_text(testing::obj_text(testing::box({0, 0, 0}, {1, 1, 1}, true, "lamp"))).scene;
    const Verified none = verify(black, Rgb(0.0));
    EXPECT_EQ(none.error.l2, 0);
    EXPECT_TRUE(none.points.empty());
}

TEST(Verify, SeveralSolutionsAreHeldToTheSamePaths)
{
    const Scene scene = furnace();
    const VerifyOptions options{300, 512, 1, {}};
    const auto points = points_to_verify(scene, options);
    const auto shows = [&](double factor) {
        return std::vector<ShownPoint>(points.size(), ShownPoint{factor * furnace_light(scene), 0});
    };
    const Verification v = verify_light(scene, RayCaster(scene), points, {shows(2), shows(1)}, options);
    ASSERT_EQ(v.solutions.size(), 2U);
    EXPECT_EQ(v.paths, 512U) << "the one without error still needs them";
    EXPECT_NEAR(v.solutions[0].error.l2, 1, 0.02);
    EXPECT_LT(v.solutions[1].error.l2, 0.03);
    EXPECT_EQ(v.solutions[0].points[7].found, v.solutions[1].points[7].found);
}

TEST(Verify, CanBeInterrupted)
{
    const Scene scene = furnace();
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(verify(scene, furnace_light(scene), {}, {stop.get_token(), {}}), Interrupted);
}

}  // namespace
}  // namespace patchlight
