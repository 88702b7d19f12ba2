#include "apps/run/vtu_file.h"

#include "apps/run/element_nodes.h"
#include "apps/run/exporting.h"
#include "apps/run/textured_glb.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gmock/gmock.h>

#include <cstring>

namespace patchlight {
namespace {

using ::testing::HasSubstr;

StoredSolution solution_of_floor(bool quadratic)
{
    StoredSolution s;
    s.scene = testing::floor_and_lamp();
    s.mesh = testing::grid_mesh(s.scene, 2);
    s.B = Radiosity(s.mesh.patch_count(), Rgb(1, 2, 3));
    s.vertex_B = VertexRadiosity(s.mesh.vertex_count(), Rgb(1, 2, 3));
    s.eta = PatchField<double>(s.mesh.patch_count(), 0.5);
    s.edge = PatchField<std::uint8_t>(s.mesh.patch_count());
    if (quadratic) s.middle_B = MidpointRadiosity(s.mesh.patch_count(), {Rgb(4), Rgb(4), Rgb(4)});
    return s;
}

TEST(ElementNodes, MiddlesOfEdgesAreShared)
{
    const StoredSolution linear = solution_of_floor(false), quadratic = solution_of_floor(true);
    EXPECT_EQ(element_nodes(linear).positions.size(), linear.mesh.vertex_count());
    const ElementNodes nodes = element_nodes(quadratic);
    // The floor's 2 x 2 squares have 16 edges, the lamp's one 5.
    EXPECT_EQ(nodes.positions.size(), linear.mesh.vertex_count() + 16 + 5);
    EXPECT_EQ(nodes.B.size(), nodes.positions.size());
    EXPECT_EQ(nodes.of_patches.size(), 6 * linear.mesh.patch_count());
}

TEST(ElementNodes, PatchesThatDoNotAgreeHaveNodesOfTheirOwn)
{
    StoredSolution s = solution_of_floor(true);
    s.middle_B[PatchId(0)][2] = Rgb(5);  // the square's diagonal
    const ElementNodes nodes = element_nodes(s);
    EXPECT_EQ(nodes.positions.size(), s.mesh.vertex_count() + 16 + 5 + 1);
    EXPECT_EQ(nodes.B[nodes.of_patches[5]], Rgb(5));
}

TEST(VtuFile, SaysWhatItHolds)
{
    const std::string file = encode_vtu(solution_of_floor(true));
    EXPECT_THAT(file, HasSubstr("header_type=\"UInt64\""));
    EXPECT_THAT(file, HasSubstr("NumberOfPoints=\"34\" NumberOfCells=\"10\""));
    // The first array begins after the underscore: its length, then its numbers.
    const std::size_t data = file.find("<AppendedData encoding=\"raw\">\n_") + 31;
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + data, sizeof length);
    EXPECT_EQ(length, 34U * 3 * 8);
    double first = 0;
    std::memcpy(&first, file.data() + data + 8, sizeof first);
    EXPECT_EQ(first, 1);
}

TEST(VtuFile, SeriesEscapesNames)
{
    EXPECT_THAT(encode_pvd({{7, "a<b>&\"c\".vtu"}}),
                HasSubstr("timestep=\"7\" part=\"0\" file=\"a&lt;b&gt;&amp;&quot;c&quot;.vtu\""));
}

TEST(Exports, AQuadraticElementBecomesFourTriangles)
{
    const std::string ply = encode_ply(solution_of_floor(true));
    EXPECT_THAT(ply, HasSubstr("element vertex 34\n"));
    EXPECT_THAT(ply, HasSubstr("element face 40\n"));
}

TEST(TexturedGlb, SharesVerticesWithinASurfaceOnly)
{
    Scene scene = testing::floor_and_lamp();
    scene.views = {View{.name = "straight down", .from = {0, 0, 3}, .forward = {0, 0, -1}, .up = {0, 0, 1}}};
    const std::string glb = encode_textured_glb(
        scene, [](SurfaceId, const Vec2& q) { return q; }, "a.exr");
    EXPECT_THAT(glb, HasSubstr("TEXCOORD_0"));
    EXPECT_THAT(glb, HasSubstr("\"count\":8"));
    EXPECT_THAT(glb, ::testing::Not(HasSubstr("emissive_strength"))) << "3/pi is below 1";
    scene.materials[1].emission = Rgb(100);
    EXPECT_THAT(encode_textured_glb(
                    scene, [](SurfaceId, const Vec2& q) { return q; }, "a.exr"),
                HasSubstr("\"emissiveStrength\":31.83"));
    EXPECT_THAT(glb, ::testing::Not(HasSubstr("null"))) << "up along the view isn't NaN";
}

}  // namespace
}  // namespace patchlight
