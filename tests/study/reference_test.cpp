#include "apps/study/reference.h"

#include "meshing/read_scene.h"
#include "tests/temporary_folder.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace patchlight {
namespace {

using testing::TemporaryFolder;

Scene scene_of(const std::string& name)
{
    return read_scene(std::string(PATCHLIGHT_DATA) + "/scenes/" + name, {}).scene;
}

std::vector<ReferencePoint> traced(const Scene& scene, const std::vector<DrawnPoint>& points,
                                   const TemporaryFolder& folder, std::stop_token stop = {},
                                   const std::function<void(double, std::size_t)>& tell = {})
{
    FileWriter writer;
    return traced_reference(scene, RayCaster(scene), points, 16, 1, {folder.path() / "blocks", writer, stop, tell});
}

void expect_same(const std::vector<ReferencePoint>& a, const std::vector<ReferencePoint>& b)
{
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].at.surface, b[i].at.surface);
        EXPECT_EQ(a[i].at.position, b[i].at.position);
        EXPECT_EQ(a[i].reflected, b[i].reflected);
        EXPECT_EQ(a[i].variance, b[i].variance);
    }
}

TEST(PathTracedReference, GoesOnFromItsBlocksToTheSameValues)
{
    const Scene scene = scene_of("cornell-box.obj");
    const auto points = reference_points(
        scene,
        {.kind = ReferenceKind::path_traced, .points = 300, .seen_from = {}, .options = {}, .file = {}, .place = {}},
        1);
    const TemporaryFolder whole, stopped;
    const auto expected = traced(scene, points, whole);
    std::stop_source stop;
    EXPECT_THROW(traced(scene, points, stopped, stop.get_token(),
                        [&](double done, std::size_t) {
                            if (done > 0.3) stop.request_stop();
                        }),
                 Interrupted);
    // Of five blocks two are there: these are not traced again.
    std::size_t fewest = 0;
    bool first = true;
    const auto resumed = traced(scene, points, stopped, {}, [&](double, std::size_t rays) {
        if (first) fewest = rays;
        first = false;
    });
    EXPECT_EQ(fewest, 0U);
    expect_same(resumed, expected);
}

TEST(PathTracedReference, TracesABrokenBlockAgain)
{
    const Scene scene = scene_of("cornell-box.obj");
    const auto points = reference_points(
        scene,
        {.kind = ReferenceKind::path_traced, .points = 100, .seen_from = {}, .options = {}, .file = {}, .place = {}},
        1);
    const TemporaryFolder folder;
    const auto expected = traced(scene, points, folder);
    (void)folder.write("blocks/00001.json", "[[1,2");
    expect_same(traced(scene, points, folder), expected);
}

TEST(Reference, IsReadAsItWasWritten)
{
    const Scene scene = scene_of("cornell-box.obj");
    const auto points = reference_points(
        scene,
        {.kind = ReferenceKind::path_traced, .points = 70, .seen_from = {}, .options = {}, .file = {}, .place = {}}, 1);
    const TemporaryFolder folder;
    const auto found = traced(scene, points, folder);
    EXPECT_FALSE(read_reference(folder.path()));
    FileWriter writer;
    write_reference(folder.path(), {{"kind", "test"}}, found, writer);
    const auto read = read_reference(folder.path());
    ASSERT_TRUE(read);
    expect_same(*read, found);
}

TEST(ReferenceSeeds, AreNoneOfTheStudysOwn)
{
    const ReferenceSeeds seeds = reference_seeds(1);
    const std::vector<std::uint64_t> all{seeds.points, seeds.paths, seeds.intervals, 1};
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(std::ranges::count(all, all[i]), 1);
    EXPECT_NE(reference_seeds(2).paths, seeds.paths);
}

TEST(ReferenceKey, TellsScenesPointsAndSourcesApartButNotCameras)
{
    Scene scene = scene_of("cornell-box.obj");
    StudyReference reference;
    reference.kind = ReferenceKind::path_traced;
    const std::string id = content_id(reference_key(reference, scene, 1, {}));
    EXPECT_EQ(id.size(), 16U);
    EXPECT_NE(content_id(reference_key(reference, scene, 2, {})), id);
    EXPECT_NE(content_id(reference_key(reference, scene, 1, "run")), id);
    scene.views.emplace_back();
    EXPECT_EQ(content_id(reference_key(reference, scene, 1, {})), id);
    scene.materials[0].reflectance *= 0.5;
    EXPECT_NE(content_id(reference_key(reference, scene, 1, {})), id);
}

TEST(FurnaceReference, IsTheClosedFormOrRefused)
{
    const Scene furnace = scene_of("furnace.obj");
    const Material& wall = furnace.material_of(SurfaceId(std::size_t{0}));
    for (const ReferencePoint& point : furnace_reference(furnace, reference_points(furnace, {}, 1), "s.toml")) {
        EXPECT_NEAR(point.reflected.r, wall.emission.r / (1 - wall.reflectance.r) - wall.emission.r, 1e-12);
        EXPECT_EQ(point.variance, Rgb(0.0));
    }
    EXPECT_THROW(furnace_reference(scene_of("cornell-box.obj"), {}, "s.toml"), StudyError);
    EXPECT_THROW(furnace_reference(scene_of("cornell-box-closed.obj"), {}, "s.toml"), StudyError);
}

TEST(GivenReference, NeedsRadiosityAtPointsOfTheSurfaces)
{
    const Scene scene = scene_of("cornell-box.obj");
    const auto given = [&](const std::string& text) { return given_reference(scene, read_points(text, "p"), "p"); };
    const auto floor = given("x,y,z,Br,Bg,Bb\n278,0,100,3,2,1\n");
    ASSERT_EQ(floor.size(), 1U);
    EXPECT_EQ(floor[0].reflected, Rgb(3, 2, 1));
    EXPECT_THROW(given("x,y,z\n278,0,100\n"), PointsError);
    EXPECT_THROW(given("x,y,z,Br,Bg,Bb\n278,1,100,3,2,1\n"), PointsError);
}

}  // namespace
}  // namespace patchlight
