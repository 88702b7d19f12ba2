#include "contact_scenes.h"

#include <gmock/gmock.h>

#include <algorithm>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// The contact lines on surfaces of a material, their ends in file coordinates.
std::vector<std::pair<Vec3, Vec3>> lines_on(const Scene& scene, const std::string& material)
{
    std::vector<std::pair<Vec3, Vec3>> lines;
    for (const SurfaceLine& line : scene.contact_lines) {
        EXPECT_EQ(line.kind, LineKind::contact);
        if (scene.material_of(line.surface).name != material) continue;
        const PlaneFrame& frame = scene.surface(line.surface).frame;
        lines.emplace_back(frame.lift(line.start) + scene.center, frame.lift(line.end) + scene.center);
    }
    return lines;
}

/// Whether there is a line with these ends, either way round.
bool has_line(const std::vector<std::pair<Vec3, Vec3>>& lines, const Vec3& a, const Vec3& b)
{
    // Recentring rounds to 1e-15 of the scene.
    const auto same = [](const Vec3& p, const Vec3& q) { return glm::distance(p, q) < 1e-13; };
    return std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
        return (same(line.first, a) && same(line.second, b)) || (same(line.first, b) && same(line.second, a));
    });
}

const Surface& largest(const Scene& scene, const std::string& material)
{
    const Surface* best = nullptr;
    for (const Surface& s : scene.surfaces) {
        if (scene.materials[s.material.value].name == material && (!best || s.area > best->area)) best = &s;
    }
    return *best;
}

double relative(double value)
{
    return 1e-12 * value;
}

}  // namespace

TEST(Contacts, the_wall_on_the_floor_is_one_line_on_the_receiver)
{
    const LoadedScene loaded = read_scene(std::filesystem::path(PATCHLIGHT_DATA) / "scenes/wall-on-floor.obj");
    ASSERT_EQ(loaded.scene.contact_lines.size(), 1U);
    EXPECT_TRUE(has_line(lines_on(loaded.scene, "receiver"), {0.52, 0.25, 0}, {0.52, 0.75, 0}));
    EXPECT_EQ(loaded.report.covered_area, 0) << "both sides of a thin plate stay";
}

TEST(Contacts, a_standing_block_leaves_a_hole_in_the_floor)
{
    for (const bool bottom : {true, false}) {
        for (const bool join_objects : {true, false}) {
            SceneOptions options;
            options.join_objects = join_objects;
            const LoadedScene loaded = load(lit_floor(red_box({1, 1, 0}, {2, 1, 1}, bottom)), options);
            expect_sound(loaded);
            EXPECT_NEAR(loaded.report.covered_area, 2, relative(2));
            EXPECT_NEAR(total_area(loaded.scene, "white"), 14, relative(14));
            EXPECT_NEAR(total_area(loaded.scene, "red"), bottom ? 10 : 8, relative(10));
            EXPECT_EQ(largest(loaded.scene, "white").loops.size(), 2U);
            EXPECT_EQ(count_of(loaded.scene, "red"), bottom ? 6U : 5U) << "a bottom faces down and stays";
            EXPECT_TRUE(loaded.scene.contact_lines.empty()) << "the foot is a border";
        }
    }
}

TEST(Contacts, what_a_block_covers_wholly_is_no_surface)
{
    const auto polygons = lit_floor(
        with(red_box({1, 1, 0}, {2, 1, 1}), rectangle({1.25, 1.25, 0}, {0.5, 0, 0}, {0, 0.5, 0}, "red", "mat")));
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    EXPECT_EQ(count_of(loaded.scene, "red"), 6U);
    EXPECT_NEAR(loaded.report.covered_area, 2, relative(2));
}

TEST(Contacts, stacked_blocks_without_bottoms_cover_floor_and_top)
{
    const LoadedScene loaded =
        load(lit_floor(with(red_box({1, 1, 0}, {2, 2, 1}, false), red_box({1.5, 1.5, 1}, {1, 1, 1}, false))));
    expect_sound(loaded);
    EXPECT_NEAR(loaded.report.covered_area, 4 + 1, relative(5));
    EXPECT_NEAR(total_area(loaded.scene, "white"), 12, relative(12));
    EXPECT_NEAR(total_area(loaded.scene, "red"), 4 * 2 + 4 - 1 + 5, relative(16));
    EXPECT_TRUE(loaded.scene.contact_lines.empty());
}

TEST(Contacts, an_upper_blocks_bottom_sees_the_floor_through_the_lower_block)
{
    const LoadedScene loaded = load(lit_floor(with(red_box({1, 1, 0}, {2, 2, 1}), red_box({1.5, 1.5, 1}, {1, 1, 1}))));
    expect_sound(loaded);
    EXPECT_NEAR(loaded.report.covered_area, 1, relative(1)) << "the lower block's top";
    EXPECT_NEAR(total_area(loaded.scene, "white"), 16, relative(16));
    EXPECT_EQ(count_of(loaded.scene, "white"), 2U) << "so the floor goes on inside, as a surface of its own";
    EXPECT_NEAR(largest(loaded.scene, "white").area, 16 - 4, relative(16));
    EXPECT_TRUE(loaded.scene.contact_lines.empty()) << "the foot is a border";
}

TEST(Contacts, a_sunk_block_covers_as_a_standing_one_does)
{
    for (const bool turn : {false, true}) {
        const LoadedScene loaded =
            load(with(room_with_lamp(), red_box({1, 1, -0.5}, {2, 1, 1})), {}, turn ? Placement(rotated) : Placement());
        expect_sound(loaded);
        expect_nothing_pierced(loaded);
        EXPECT_TRUE(loaded.scene.closed);
        EXPECT_EQ(loaded.report.crossing_faces, 4U);
        EXPECT_NEAR(loaded.report.covered_area, 2, relative(2));
        EXPECT_NEAR(total_area(loaded.scene, "white"), 16 - 2 + 15 + 48, relative(77));
        EXPECT_NEAR(total_area(loaded.scene, "red"), 10, relative(10));
        EXPECT_EQ(count_of(loaded.scene, "red"), 10U) << "each side is in the room above the floor, outside below it";
        EXPECT_TRUE(loaded.scene.contact_lines.empty()) << "the floor ends there, and each side";
    }
}

TEST(Contacts, blocks_through_each_other_divide_the_six_faces_that_meet)
{
    const LoadedScene loaded =
        load(with(with({lamp_above}, red_box({0, 0, 0}, {2, 2, 2})), red_box({1, 1, 1}, {2, 2, 2})));
    expect_sound(loaded);
    expect_nothing_pierced(loaded);
    EXPECT_EQ(loaded.report.crossing_faces, 6U);
    EXPECT_NEAR(total_area(loaded.scene, "red"), 48, relative(48));
    EXPECT_EQ(loaded.report.covered_area, 0) << "three planes show inside either block";
    EXPECT_EQ(count_of(loaded.scene, "red"), 6U + 2 * 6U) << "a piece of each face is inside the other block";
    EXPECT_TRUE(loaded.scene.contact_lines.empty()) << "they end at one another";
}

TEST(Contacts, a_block_in_a_rooms_corner_covers_nothing_as_walls_and_floor_see_one_another)
{
    for (const bool bottom : {true, false}) {
        const LoadedScene loaded = load(with(room_with_lamp(), red_box({0, 0, 0}, {1, 1, 1}, bottom)));
        expect_sound(loaded);
        EXPECT_TRUE(loaded.scene.closed);
        EXPECT_EQ(loaded.report.covered_area, 0);
        EXPECT_NEAR(total_area(loaded.scene, "white"), 79, relative(79));
        EXPECT_EQ(count_of(loaded.scene, "white"), 6U + 3U) << "what is inside the block is of its own";
        EXPECT_TRUE(loaded.scene.contact_lines.empty());
    }
}

TEST(Contacts, a_box_on_a_wall_without_a_back_leaves_a_hole_in_the_wall)
{
    auto shelf = red_box({0, 1, 1}, {1, 1, 1});
    shelf.erase(std::find_if(shelf.begin(), shelf.end(), [](const Polygon& p) { return normal_of(p).x < 0; }));
    const LoadedScene loaded = load(with(room_with_lamp(), shelf));
    expect_sound(loaded);
    EXPECT_NEAR(loaded.report.covered_area, 1, relative(1));
    EXPECT_NEAR(total_area(loaded.scene, "white"), 78, relative(78));
    EXPECT_TRUE(loaded.scene.contact_lines.empty());
}

TEST(Contacts, a_foot_turned_by_less_than_snapping_stands)
{
    const auto tilted = [](double angle) {
        auto block = red_box({1, 1, 0}, {2, 1, 1});
        for (Polygon& side : block) {
            for (Vec3& p : side.corners)
                p = {p.x * std::cos(angle) - p.z * std::sin(angle), p.y, p.x * std::sin(angle) + p.z * std::cos(angle)};
        }
        return load(lit_floor(block));
    };
    for (const double angle : {1e-9, -1e-9, 1e-8, -1e-8}) {
        const LoadedScene loaded = tilted(angle);
        expect_sound(loaded);
        EXPECT_EQ(loaded.report.crossing_faces, 0U);
        // The foot is shifted and turned by the angle.
        EXPECT_NEAR(loaded.report.covered_area, 2, 1e-12);
        EXPECT_NEAR(total_area(loaded.scene, "white"), 14, 1e-12);
        EXPECT_TRUE(loaded.scene.contact_lines.empty());
    }
    for (const double angle : {3e-8, 1e-7, 1e-6, 1e-4, -3e-8, -1e-7, -1e-6, -1e-4}) {
        const LoadedScene loaded = tilted(angle);
        expect_sound(loaded);
        expect_nothing_pierced(loaded);
    }
}

TEST(Contacts, a_plate_through_a_plate_shares_the_segment)
{
    const std::vector<Polygon> polygons = {lamp_above, rectangle({1, 1, 1}, {1, 0, 0}, {0, 1, 0}, "white"),
                                           rectangle({1.5, 1.25, 0.5}, {0, 0.5, 0}, {0, 0, 1}, "red")};
    const Vec3 a{1.5, 1.25, 1}, b{1.5, 1.75, 1};
    for (const bool two_sided : {false, true}) {
        SceneOptions options;
        options.all_two_sided = two_sided;
        const LoadedScene loaded = load(polygons, options);
        expect_sound(loaded);
        expect_nothing_pierced(loaded);
        EXPECT_EQ(loaded.report.crossing_faces, 1U);
        EXPECT_EQ(loaded.report.t_junctions, 0U);
        const Scene& scene = loaded.scene;
        int shared = 0;
        for (const SceneTriangle& t : scene.triangles) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 p = scene.vertices[t.vertices[k]] + scene.center,
                           q = scene.vertices[t.vertices[(k + 1) % 3]] + scene.center;
                shared += has_line({{p, q}}, a, b);
            }
        }
        EXPECT_EQ(shared, 4) << "two triangles of either plate";
        for (const std::string material : {"white", "red"}) {
            const auto lines = lines_on(scene, material);
            EXPECT_EQ(lines.size(), two_sided ? 2U : 1U);
            EXPECT_TRUE(has_line(lines, a, b));
        }
    }
}

TEST(Contacts, a_fork_through_a_plate_meets_it_in_two_segments)
{
    const Polygon fork{{{1.25, 1.5, 0.5},
                        {1.375, 1.5, 0.5},
                        {1.375, 1.5, 1.25},
                        {1.625, 1.5, 1.25},
                        {1.625, 1.5, 0.5},
                        {1.75, 1.5, 0.5},
                        {1.75, 1.5, 1.5},
                        {1.25, 1.5, 1.5}},
                       "red",
                       "fork"};
    const LoadedScene loaded = load({lamp_above, rectangle({1, 1, 1}, {1, 0, 0}, {0, 1, 0}), fork});
    expect_sound(loaded);
    expect_nothing_pierced(loaded);
    EXPECT_EQ(loaded.report.crossing_faces, 1U);
    const auto lines = lines_on(loaded.scene, "white");
    EXPECT_EQ(lines.size(), 2U);
    EXPECT_TRUE(has_line(lines, {1.25, 1.5, 1}, {1.375, 1.5, 1}));
    EXPECT_TRUE(has_line(lines, {1.625, 1.5, 1}, {1.75, 1.5, 1}));
}

TEST(Contacts, walls_that_cross_on_a_floor_are_one_line_each)
{
    const LoadedScene loaded = load(lit_floor({rectangle({1, 2, 0}, {2, 0, 0}, {0, 0, 1}, "red", "one"),
                                               rectangle({2, 1, 0}, {0, 2, 0}, {0, 0, 1}, "red", "other")}));
    expect_sound(loaded);
    expect_nothing_pierced(loaded);
    const auto lines = lines_on(loaded.scene, "white");
    EXPECT_EQ(lines.size(), 2U) << "their four pieces are chained";
    EXPECT_TRUE(has_line(lines, {1, 2, 0}, {3, 2, 0}));
    EXPECT_TRUE(has_line(lines, {2, 1, 0}, {2, 3, 0}));
    const auto upright = lines_on(loaded.scene, "red");
    EXPECT_EQ(upright.size(), 2U);
    EXPECT_TRUE(has_line(upright, {2, 2, 0}, {2, 2, 1}));
}

TEST(Contacts, a_lamp_inside_a_box_without_bottom_uncovers_the_floor)
{
    const auto boxed = red_box({1, 1, 0}, {2, 1, 1}, false);
    const auto lamp = rectangle({1.5, 1.25, 0.5}, {0, 0.5, 0}, {0.5, 0, 0}, "lamp", "inside");
    const LoadedScene loaded = load(lit_floor(with(boxed, lamp)));
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.covered_area, 0);
    EXPECT_NEAR(total_area(loaded.scene, "white"), 16, relative(16));
    EXPECT_EQ(count_of(loaded.scene, "white"), 2U) << "the floor of the box, and around it";
    EXPECT_TRUE(loaded.scene.contact_lines.empty());
    EXPECT_NEAR(load(lit_floor(boxed)).report.covered_area, 2, relative(2));
}

TEST(Contacts, touching_blocks_cover_each_others_sides)
{
    const LoadedScene loaded =
        load(with(with({lamp_above}, red_box({0, 0, 0}, {1, 1, 1})), red_box({1, -0.5, -0.5}, {2, 2, 2})));
    expect_sound(loaded);
    EXPECT_NEAR(loaded.report.covered_area, 2, relative(2)) << "one side wholly, of the other as much";
    EXPECT_NEAR(total_area(loaded.scene, "red"), 6 + 24 - 2, relative(28));
    EXPECT_EQ(count_of(loaded.scene, "red"), 11U);
    EXPECT_TRUE(loaded.scene.contact_lines.empty());
}

TEST(Contacts, a_scene_whose_only_emitter_is_covered_is_dark)
{
    const auto boxed = red_box({1, 1, 0}, {2, 1, 1}, false);
    const std::vector<Polygon> polygons =
        with({floor_below, rectangle({1.5, 1.25, 0}, {0.5, 0, 0}, {0, 0.5, 0}, "lamp", "lamp")}, boxed);
    EXPECT_THAT(error_of([&] { load(polygons); }), ::testing::HasSubstr("dark"));
}

TEST(Contacts, the_order_of_faces_and_of_their_corners_does_not_matter)
{
    auto polygons = lit_floor(with(red_box({1, 1, -0.3}, {2, 1, 1}), red_box({0.7, 1.3, 0.2}, {1, 1, 1})));
    polygons.push_back(rectangle({3.5, 0.2, -0.1}, {0.3, 0.1, 0.1}, {0.1, 0.4, 0.6}, "red", "plate"));
    polygons = with(polygons, red_box({3, 3, 0}, {0.5, 0.5, 0.5}));
    const LoadedScene straight = load(polygons, {}, rotated);
    expect_sound(straight);
    expect_nothing_pierced(straight);
    EXPECT_GT(straight.scene.contact_lines.size(), 5U);
    EXPECT_GT(straight.report.covered_area, 0.2);
    std::mt19937 random(7);
    for (int round = 0; round < 5; ++round) {
        std::shuffle(polygons.begin(), polygons.end(), random);
        for (Polygon& p : polygons) std::rotate(p.corners.begin(), p.corners.begin() + 1, p.corners.end());
        expect_same_scene(straight.scene, load(polygons, {}, rotated).scene);
    }
}
