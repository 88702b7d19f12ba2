#include "apps/run/probing.h"
#include "apps/run/stored_solution.h"
#include "meshing/scene_error.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

/// x² on the floor, in quadratic elements.
StoredSolution lit_by_a_parabola()
{
    StoredSolution s;
    s.scene = testing::floor_and_lamp();
    s.mesh = testing::grid_mesh(s.scene, 3);
    s.B = Radiosity(s.mesh.patch_count());
    s.vertex_B = VertexRadiosity(s.mesh.vertex_count());
    s.middle_B = MidpointRadiosity(s.mesh.patch_count());
    s.eta = PatchField<double>(s.mesh.patch_count());
    s.edge = PatchField<std::uint8_t>(s.mesh.patch_count());
    const auto light = [](const Vec3& p) { return Rgb(p.x * p.x, 1.0 / 3, 1e-300); };
    for (const VertexId v : s.mesh.vertices()) {
        s.vertex_B[v] = light(s.mesh.position(v));
    }
    for (const PatchId p : s.mesh.patches()) {
        const auto c = s.mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            s.middle_B[p][k] = light(0.5 * (s.mesh.position(c[k]) + s.mesh.position(c[(k + 1) % 3])));
        }
    }
    return s;
}

std::string encoded(const StoredSolution& s)
{
    return encode_solution(s.scene, s.mesh, s.B, s.vertex_B, s.eta, s.edge, s.middle_B);
}

TEST(StoredElements, MidpointsComeBackEqualToTheBit)
{
    StoredSolution stored = lit_by_a_parabola();
    EXPECT_EQ(decode_solution(encoded(stored), "s").middle_B, stored.middle_B);
    stored.middle_B = {};
    EXPECT_TRUE(decode_solution(encoded(stored), "s").middle_B.empty());
}

TEST(StoredElements, TooFewMidpointsAreRefused)
{
    StoredSolution stored = lit_by_a_parabola();
    stored.middle_B = MidpointRadiosity(stored.mesh.patch_count() - 1);
    EXPECT_THROW(decode_solution(encoded(stored), "s"), SceneError);
}

TEST(StoredElements, AreProbed)
{
    StoredSolution stored = lit_by_a_parabola();
    const auto at = [&](double x) {
        return SurfaceProbe(stored).at(ProbePoint{(Vec3(x, 0.4, 0) + stored.scene.center) / stored.scene.unit, {}, {}});
    };
    EXPECT_NEAR(at(0.21)->B.r, 0.21 * 0.21, 1e-12);
    stored.middle_B = {};
    EXPECT_NEAR(at(0.21)->B.r, 0.21 / 3, 1e-12) << "from 0 to 1/9 along a third";
}

}  // namespace
}  // namespace patchlight
