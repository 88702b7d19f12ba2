#include "apps/run/stored_solution.h"

#include "apps/run/byte_views.h"
#include "apps/run/exporting.h"
#include "apps/run/stored_scene.h"
#include "meshing/refinement.h"
#include "meshing/scene_error.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <random>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

/// Numbers with all their digits in use, so that nothing short of every bit will do.
double awkward(std::size_t i)
{
    return 1.0 / (3.0 + static_cast<double>(i) * 0.7310585786300049);
}

struct Stored {
    Scene scene = floor_and_lamp();
    PatchMesh mesh = grid_mesh(scene, 3);
    Radiosity B = Radiosity(mesh.patch_count());
    VertexRadiosity vertex_B = VertexRadiosity(mesh.vertex_count());
    PatchField<double> eta = PatchField<double>(mesh.patch_count());
    PatchField<std::uint8_t> edge = PatchField<std::uint8_t>(mesh.patch_count());

    Stored()
    {
        View view;
        view.name = "a \"quoted\" käse\n";
        view.from = {awkward(1), awkward(2), awkward(3)};
        scene.views = {view};
        for (std::size_t i = 0; i < B.size(); ++i) {
            B[PatchId(i)] = {awkward(3 * i), awkward(3 * i + 1), 1e-300};
            eta[PatchId(i)] = awkward(i);
            edge[PatchId(i)] = static_cast<std::uint8_t>(i % 3);
        }
        for (std::size_t i = 0; i < vertex_B.size(); ++i) {
            vertex_B[VertexId(i)] = {awkward(i), 0, 1e9 + awkward(i)};
        }
    }
    std::string encoded() const { return encode_solution(scene, mesh, B, vertex_B, eta, edge); }
};

TEST(StoredSolution, ComesBackEqualToTheBit)
{
    const Stored stored;
    const StoredSolution back = decode_solution(stored.encoded(), "solution.glb");
    EXPECT_EQ(back.B, stored.B);
    EXPECT_EQ(back.vertex_B, stored.vertex_B);
    EXPECT_EQ(back.eta, stored.eta);
    EXPECT_EQ(back.edge, stored.edge);
    EXPECT_EQ(back.mesh.arrays().positions, stored.mesh.arrays().positions);
    EXPECT_EQ(back.mesh.arrays().triangles, stored.mesh.arrays().triangles);
    EXPECT_EQ(back.mesh.arrays().vertex_surface, stored.mesh.arrays().vertex_surface);
    EXPECT_EQ(back.scene.views.at(0).name, stored.scene.views.at(0).name);
    EXPECT_EQ(back.scene.views.at(0).from, stored.scene.views.at(0).from);
    EXPECT_EQ(back.scene.surfaces.at(1).loops, stored.scene.surfaces.at(1).loops);
    EXPECT_EQ(scene_digest(back.scene), scene_digest(stored.scene));
    EXPECT_EQ(encode_solution(back.scene, back.mesh, back.B, back.vertex_B, back.eta, back.edge), stored.encoded());
}

// A contact line, cut open, with what goes on beyond its ends; and a line of another kind.
TEST(StoredSolution, LinesAndTheirSidesComeBack)
{
    Stored stored;
    const SurfaceId floor(0);
    const std::vector<SurfaceLine> lines{{floor, LineKind::contact, {0.3, 0.4}, {0.7, 0.5}},
                                         {floor, LineKind::plane, {0.1, 0.9}, {0.6, 0.1}}};
    stored.mesh = triangulate(stored.scene, {.max_edge = 0.3}, lines);
    stored.B = Radiosity(stored.mesh.patch_count());
    stored.vertex_B = VertexRadiosity(stored.mesh.vertex_count());
    stored.eta = PatchField<double>(stored.mesh.patch_count());
    stored.edge = PatchField<std::uint8_t>(stored.mesh.patch_count());
    // Both sides have light of their own.
    for (std::size_t i = 0; i < stored.vertex_B.size(); ++i) stored.vertex_B[VertexId(i)] = Rgb(awkward(i));
    const StoredSolution back = decode_solution(stored.encoded(), "solution.glb");
    EXPECT_EQ(back.vertex_B, stored.vertex_B);
    EXPECT_EQ(back.mesh.arrays().triangles, stored.mesh.arrays().triangles);
    ASSERT_EQ(back.mesh.lines().size(), stored.mesh.lines().size());
    std::size_t beyond = 0, cut = 0;
    for (std::size_t i = 0; i < back.mesh.lines().size(); ++i) {
        const MeshLine &a = back.mesh.lines()[i], &b = stored.mesh.lines()[i];
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.left, b.left);
        EXPECT_EQ(a.right, b.right);
        EXPECT_EQ(a.beyond, b.beyond);
        beyond += a.beyond;
        cut += a.left != a.right;
    }
    EXPECT_EQ(beyond, 2U);
    EXPECT_GE(cut, 4U);
    EXPECT_EQ(stored.encoded(), encode_solution(back.scene, back.mesh, back.B, back.vertex_B, back.eta, back.edge));
    // And it goes on being refined as it would have.
    RefinementPlan plan;
    for (const PatchId p : stored.mesh.patches()) plan.bisections.push_back({p, 0});
    EXPECT_EQ(refine(back.scene, back.mesh, plan, {}).mesh.arrays().positions,
              refine(stored.scene, stored.mesh, plan, {}).mesh.arrays().positions);
}

TEST(StoredSolution, NamesThatAreNotUtf8DoNotStopIt)
{
    Stored stored;
    stored.scene.materials[0].name = "wei\xdf";
    stored.scene.name = "\xff";
    EXPECT_EQ(decode_solution(stored.encoded(), "s").B, stored.B);
}

TEST(StoredSolution, IsAGlbWhosePositionsAreRelativeToTheCentre)
{
    const std::string bytes = Stored().encoded();
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 8, 4);
    EXPECT_EQ(length, bytes.size());
    EXPECT_THAT(bytes, ::testing::HasSubstr("_RADIOSITY"));
    EXPECT_THAT(bytes, ::testing::HasSubstr("\"translation\":[10.0,20.0,30.0]"));
}

TEST(StoredSolution, CutAnywhereItIsAnErrorAndNeverAnAnswer)
{
    const std::string whole = Stored().encoded();
    for (std::size_t size = 0; size < whole.size(); size += size < 2000 ? 7 : 97) {
        EXPECT_THROW(decode_solution(whole.substr(0, size), "cut"), SceneError) << size;
    }
}

TEST(StoredSolution, DamagedBytesNeverCrash)
{
    const std::string whole = Stored().encoded();
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < 1500; ++i) {
        std::string damaged = whole;
        for (int k = 0; k < 3; ++k) {
            damaged[random() % damaged.size()] = static_cast<char>(random());
        }
        try {
            decode_solution(damaged, "damaged");
        } catch (const SceneError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100) << "damage in the header, an index or a size must be seen";
}

// Found by fuzzing: a frame of huge vectors made plane coordinates that are not numbers, and of these, indices.
TEST(StoredSolution, PlacesAndFramesThatCannotBeAreRefused)
{
    using Change = std::function<void(Stored&)>;
    const std::vector<Change> changes{[](Stored& s) { s.scene.surfaces[0].frame.u *= 1e200; },
                                      [](Stored& s) { s.scene.surfaces[0].frame.n *= -1; },
                                      [](Stored& s) { s.scene.surfaces[0].frame.v = s.scene.surfaces[0].frame.u; },
                                      [](Stored& s) { s.scene.surfaces[0].frame.origin.x = 1e300; },
                                      [](Stored& s) { s.scene.vertices[0].y = -1e300; },
                                      [](Stored& s) { s.scene.diameter = 0; },
                                      [](Stored& s) { s.scene.unit = -1; }};
    for (std::size_t k = 0; k < changes.size(); ++k) {
        Stored stored;
        changes[k](stored);
        EXPECT_THROW(decode_solution(stored.encoded(), "changed"), SceneError) << k;
    }
}

TEST(StoredSolution, DeepNestingIsRefusedBeforeItIsParsed)
{
    const std::string json = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(1'000'000, '[') +
                             std::string(1'000'000, ']') + "}  ";
    const auto number = [](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    const std::string glb = "glTF" + number(2) + number(20 + json.size()) + number(json.size()) + "JSON" + json;
    EXPECT_THROW(decode_solution(glb, "deep"), SceneError);
}

TEST(JsonDepth, CountsBracketsOutsideOfStrings)
{
    EXPECT_EQ(json_depth("{\"a\":[1,{\"b\":\"[[[[\\\"[[\"}]}"), 3U);
    EXPECT_EQ(json_depth("7"), 0U);
}

TEST(ByteViews, ANumberThatIsNotFiniteIsRefused)
{
    const double values[] = {1, std::numeric_limits<double>::quiet_NaN()};
    const ByteViews views{{"x", bytes_of(std::span<const double>(values))}};
    EXPECT_THROW(doubles_in(views, "x"), SceneError);
    EXPECT_THROW(doubles_in(views, "y"), SceneError);
}

TEST(Exports, AreOfTheWholeMeshInTheFilesCoordinates)
{
    const Stored stored;
    const StoredSolution solution = decode_solution(stored.encoded(), "s");
    const std::string csv = encode_csv(solution);
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), stored.mesh.patch_count() + 1);
    const std::string ply = encode_ply(solution);
    const auto end = ply.find("end_header\n") + 11;
    const std::size_t vertex_bytes = 3 * 8 + 3 + 3 * 4, face_bytes = 1 + 3 * 4 + 4;
    EXPECT_EQ(ply.size(), end + stored.mesh.vertex_count() * vertex_bytes + stored.mesh.patch_count() * face_bytes);
    double first[3];
    std::memcpy(first, ply.data() + end, sizeof first);
    EXPECT_EQ(first[0], 20) << "(0 + 10 m) / 0.5 m a unit";
    EXPECT_EQ(first[2], 60);
}

}  // namespace
}  // namespace patchlight
