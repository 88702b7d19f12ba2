// Ten million rays of ours in closed rooms: none gets out. Light goes the way it goes when solving: from the emitters,
// and on from wherever a front was met.
#include "formfactor/random_numbers.h"
#include "formfactor/ray_caster.h"
#include "meshing/read_scene.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace patchlight {
namespace {

/// Cosine-weighted about the normal.
Vec3 random_direction(const PlaneFrame& frame, RandomNumbers& random)
{
    const double r = std::sqrt(random.uniform()), phi = 2 * std::numbers::pi * random.uniform();
    const double x = r * std::cos(phi), y = r * std::sin(phi);
    return x * frame.u + y * frame.v + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * frame.n;
}

/// The triangles of each surface: rays start inside them, as the solver's do, and not where a ray of single precision
/// ended.
std::vector<std::vector<const SceneTriangle*>> triangles_by_surface(const Scene& scene)
{
    std::vector<std::vector<const SceneTriangle*>> result(scene.surfaces.size());
    for (const SceneTriangle& t : scene.triangles)
        for (const SurfaceId s : {t.front, t.back})
            if (s.valid()) result[s.value].push_back(&t);
    return result;
}

Vec3 random_place(const Scene& scene, const std::vector<const SceneTriangle*>& triangles, RandomNumbers& random)
{
    const auto& v = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))]->vertices;
    const double r = std::sqrt(random.uniform()), q = random.uniform();
    return (1 - r) * scene.vertices[v[0]] + r * (1 - q) * scene.vertices[v[1]] + r * q * scene.vertices[v[2]];
}

std::vector<std::uint32_t> lamps_of(const Scene& scene)
{
    std::vector<std::uint32_t> lamps;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(std::size_t{s})).emits()) lamps.push_back(s);
    return lamps;
}

/// How many of `rays` escape.
std::size_t escaping(const Scene& scene, std::size_t rays)
{
    constexpr std::size_t side_by_side = 4096, groups = 16;
    const RayCaster caster(scene);
    const std::size_t steps = rays / (side_by_side * groups) + 1;
    const std::vector<std::uint32_t> lamps = lamps_of(scene);
    const auto triangles = triangles_by_surface(scene);
    std::atomic<std::size_t> escaped = 0;
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t group) {
        std::vector<std::uint32_t> at(side_by_side);
        for (std::size_t i = 0; i < side_by_side; ++i) at[i] = lamps[i % lamps.size()];
        RandomNumbers random(7, group);
        RayBatch batch;
        HitBatch hits;
        batch.resize(side_by_side);
        for (std::size_t step = 0; step < steps; ++step) {
            for (std::size_t i = 0; i < side_by_side; ++i) {
                const PlaneFrame& frame = scene.surfaces[at[i]].frame;
                batch.set(i, caster.leave(random_place(scene, triangles[at[i]], random), frame.n),
                          random_direction(frame, random), std::numeric_limits<float>::infinity());
            }
            caster.closest(batch, hits);
            for (std::size_t i = 0; i < side_by_side; ++i) {
                const std::uint32_t surface = hits.surface[i];
                if (surface == HitBatch::escaped) ++escaped;
                at[i] = surface < scene.surfaces.size() ? surface : lamps[i % lamps.size()];
            }
        }
    });
    return escaped;
}

class Watertight : public ::testing::TestWithParam<const char*> {};

TEST_P(Watertight, NoRayEscapes)
{
    const Scene scene = read_scene(std::string(PATCHLIGHT_DATA "/scenes/") + GetParam()).scene;
    ASSERT_TRUE(scene.closed);
    EXPECT_EQ(escaping(scene, 3'400'000), 0U) << GetParam() << ": ten million rays in three rooms";
}

// The furnace is rotated and not convex; the furniture stands on the floor, and its boards on one another.
INSTANTIATE_TEST_SUITE_P(Rooms, Watertight,
                         ::testing::Values("cornell-box-closed.obj", "furniture-room.obj", "furnace.obj"));

// The test can fail: without a wall many get out.
TEST(OpenRoom, AMissingWallIsNoticed)
{
    SceneOptions millimetres;
    millimetres.unit = 1e-3;
    EXPECT_GT(escaping(read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", millimetres).scene, 100'000), 1000U);
}

}  // namespace
}  // namespace patchlight
