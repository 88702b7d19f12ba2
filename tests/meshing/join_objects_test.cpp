#include "written_scene.h"

#include <gmock/gmock.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// Two tiles and a third of another material, edge to edge in one plane, and one more of the first object.
std::vector<Polygon> tiles()
{
    return {rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, "white", "left"),
            rectangle({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, "white", "right"),
            rectangle({2, 0, 0}, {1, 0, 0}, {0, 1, 0}, "red", "right"),
            rectangle({0, 1, 0}, {1, 0, 0}, {0, 1, 0}, "white", "left")};
}

SceneOptions dark(bool join_objects)
{
    SceneOptions options;
    options.require_emitter = false;
    options.join_objects = join_objects;
    return options;
}

double area_of(const Scene& scene, const std::string& object)
{
    double area = 0;
    for (const Surface& surface : scene.surfaces)
        if (scene.objects[surface.object.value] == object) area += surface.area;
    return area;
}

}  // namespace

TEST(JoinObjects, coplanar_faces_of_one_material_join_unless_objects_are_to_stay_apart)
{
    EXPECT_EQ(load(tiles(), dark(true)).scene.surfaces.size(), 2U);
    const LoadedScene apart = load(tiles(), dark(false));
    expect_sound(apart);
    EXPECT_EQ(apart.scene.surfaces.size(), 3U) << "the left object's two tiles still join";
    EXPECT_NEAR(area_of(apart.scene, "left"), 2, 1e-14);
    EXPECT_NEAR(area_of(apart.scene, "right"), 2, 1e-14);
}

TEST(JoinObjects, objects_keep_their_own_on_both_sides)
{
    SceneOptions options = dark(false);
    options.all_two_sided = true;
    const LoadedScene apart = load(tiles(), options, rotated);
    expect_sound(apart);
    EXPECT_EQ(apart.scene.surfaces.size(), 6U);
    EXPECT_NEAR(area_of(apart.scene, "left"), 4, 1e-12);
}

TEST(JoinObjects, a_room_in_parts_is_as_closed_as_before)
{
    const LoadedScene apart = load(room_with_lamp(), dark(false));
    expect_sound(apart);
    EXPECT_TRUE(apart.scene.closed);
}

TEST(JoinObjects, objects_whose_faces_have_no_area_are_named)
{
    std::vector<Polygon> polygons = tiles();
    polygons.push_back({{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, "white", "thread"});
    polygons.push_back({{{0, 0, 2}, {1, 0, 2}, {2, 0, 2}}, "white", "left"});
    const LoadedScene loaded = load(polygons, dark(false));
    EXPECT_EQ(loaded.report.empty_objects, std::vector<std::string>{"thread"});
    EXPECT_EQ(loaded.report.zero_area_faces, 2U);
}
