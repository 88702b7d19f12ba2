#include "apps/run/probing.h"

#include "tests/imaging/floor_and_lamp.h"

#include <gmock/gmock.h>

#include <cmath>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

StoredSolution lit_linearly()
{
    StoredSolution s;
    s.scene = floor_and_lamp();
    s.mesh = grid_mesh(s.scene, 4);
    s.B = Radiosity(s.mesh.patch_count());
    s.vertex_B = VertexRadiosity(s.mesh.vertex_count());
    s.eta = PatchField<double>(s.mesh.patch_count());
    for (VertexId v : s.mesh.vertices()) {
        const Vec3& p = s.mesh.position(v);
        s.vertex_B[v] = {1 + p.x, 2 + p.y, 3 + p.z};
    }
    return s;
}

/// Of metres relative to the centre, in the file's units.
ProbePoint at(const Vec3& metres, std::optional<Vec3> normal = std::nullopt)
{
    const Scene scene = floor_and_lamp();
    return {(metres + scene.center) / scene.unit, normal, {}};
}

TEST(SurfaceProbe, GivesTheLinearReconstructionAlsoOnEdgesAndCorners)
{
    const StoredSolution s = lit_linearly();
    const SurfaceProbe probe(s);
    for (const Vec3& p :
         {Vec3{0.3, 0.4, 0}, Vec3{0.25, 0.5, 0}, Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{1, 0.3, 0}, Vec3{0.5, 0.5, 0}}) {
        const auto answer = probe.at(at(p));
        ASSERT_TRUE(answer);
        // File coordinates around 60 cost a few of the last bits.
        EXPECT_NEAR(answer->B.r, 1 + p.x, 1e-12);
        EXPECT_NEAR(answer->B.g, 2 + p.y, 1e-12);
    }
}

TEST(SurfaceProbe, TheNormalPicksTheSide)
{
    const StoredSolution s = lit_linearly();
    const SurfaceProbe probe(s);
    EXPECT_TRUE(probe.at(at({0.5, 0.5, 0}, Vec3(0.1, 0, 2))));
    EXPECT_FALSE(probe.at(at({0.5, 0.5, 0}, Vec3(0, 0, -1)))) << "a one-sided floor has nothing below";
    EXPECT_EQ(probe.at(at({0.5, 0.5, 1}, Vec3(0, 0, -1)))->surface, SurfaceId(1));
}

TEST(SurfaceProbe, OffTheSurfacesThereIsNoAnswer)
{
    const StoredSolution s = lit_linearly();
    const SurfaceProbe probe(s);
    const double reach = 1e-6 * s.scene.diameter;
    EXPECT_TRUE(probe.at(at({0.5, 0.5, 0.5 * reach})));
    EXPECT_FALSE(probe.at(at({0.5, 0.5, 2 * reach})));
    EXPECT_FALSE(probe.at(at({1 + 2 * reach, 0.5, 0})));
    EXPECT_FALSE(probe.at(at({1e30, 0, 0})));
}

TEST(ProbeCsv, HasARowForEveryPoint)
{
    const StoredSolution s = lit_linearly();
    const auto points = read_points("x,y,z\n20.0,40,60\n0,0,0\n", "p.csv");
    EXPECT_EQ(probe_csv(points, SurfaceProbe(s).at(points)), "x,y,z,Br,Bg,Bb,surface\n20.0,40,60,1,2,3,0\n0,0,0,,,,\n");
}

TEST(ReadPoints, TakesWhatIsKnownAtPointsToo)
{
    const auto points = read_points("x,y,z,Br,Bg,Bb,surface\n1,2,3,0.5,0.25,0,7\n", "p.csv");
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].B, Rgb(0.5, 0.25, 0));
    EXPECT_FALSE(points[0].normal);
    EXPECT_THROW(read_points("x,y,z,Br,Bb\n1,2,3,0.5,0\n", "p.csv"), PointsError);
    EXPECT_THROW(read_points("x,y,z,Br,Bg,Bb\n1,2,3,1,x,1\n", "p.csv"), PointsError);
    EXPECT_FALSE(read_points("x,y,z,Br,Bg,Bb\n1,2,3,,,\n", "p.csv")[0].B);
}

TEST(ReadPoints, TakesHeadersInAnyOrderAndBothLineEnds)
{
    const auto points = read_points("\xef\xbb\xbfname,nz,ny,nx,Z,Y,X\r\n\"a\",1,0,0,3,2,+1e0\r\n\r\n", "p.csv");
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].position, Vec3(1, 2, 3));
    EXPECT_EQ(*points[0].normal, Vec3(0, 0, 1));
}

TEST(ReadPoints, SaysWhereItDoesNotUnderstand)
{
    const auto complaint = [](const std::string& text) -> std::string {
        try {
            read_points(text, "p.csv");
        } catch (const PointsError& error) {
            return error.what();
        }
        return "none";
    };
    using ::testing::StartsWith;
    EXPECT_THAT(complaint("1,2,3\n1,2\n"), StartsWith("p.csv:2: 2 values"));
    EXPECT_THAT(complaint("1,2\n"), StartsWith("p.csv:1:"));
    EXPECT_THAT(complaint("1,2,3\n\n1,2,nan\n"), StartsWith("p.csv:3: \"nan\""));
    EXPECT_THAT(complaint("1,2,1e999\n"), StartsWith("p.csv:1:"));
    EXPECT_THAT(complaint("1,2,0x3\n"), StartsWith("p.csv:1:"));
    EXPECT_THAT(complaint("x,y\n"), StartsWith("p.csv:1: the header"));
    EXPECT_THAT(complaint("x,y,z,nx\n"), StartsWith("p.csv:1: the header"));
    EXPECT_THAT(complaint("1,2,3,0,0,0\n"), StartsWith("p.csv:1: the normal"));
    EXPECT_EQ(complaint(""), "none");
}

}  // namespace
}  // namespace patchlight
