#include "written_scene.h"

#include <chrono>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// Every polygon cut into a fan of triangles.
std::vector<Polygon> triangulated(const std::vector<Polygon>& polygons)
{
    std::vector<Polygon> triangles;
    for (const Polygon& p : polygons) {
        for (std::size_t k = 1; k + 1 < p.corners.size(); ++k) {
            triangles.push_back({{p.corners[0], p.corners[k], p.corners[k + 1]}, p.material, p.object});
        }
    }
    return triangles;
}

}  // namespace

TEST(BuildScene, triangulated_walls_are_one_surface_each)
{
    const LoadedScene loaded = load(triangulated(room_with_lamp()));
    expect_sound(loaded);
    EXPECT_EQ(loaded.scene.surfaces.size(), 7U) << "floor, four walls, ceiling, lamp";
    EXPECT_TRUE(loaded.scene.closed);
    EXPECT_NEAR(total_area(loaded.scene, "white"), 16 + 15 + 4 * 12, 1e-12);
    EXPECT_NEAR(total_area(loaded.scene, "lamp"), 1, 1e-12);
}

TEST(BuildScene, ceiling_cut_round_the_lamp_has_a_hole)
{
    const LoadedScene loaded = load(room_with_lamp());
    expect_sound(loaded);
    int holes = 0;
    for (const Surface& surface : loaded.scene.surfaces) {
        holes += static_cast<int>(surface.loops.size()) - 1;
        for (const auto& loop : surface.loops) EXPECT_EQ(loop.size(), 4U) << "collinear vertices are left out";
    }
    EXPECT_EQ(holes, 1);
    EXPECT_GT(loaded.report.t_junctions, 0U) << "the ceiling's four pieces meet at T-junctions";
}

TEST(BuildScene, a_room_without_a_wall_is_open)
{
    std::vector<Polygon> room = room_with_lamp();
    room.erase(room.begin() + 1);
    EXPECT_FALSE(load(room).scene.closed);
}

TEST(BuildScene, what_floats_in_a_closed_room_leaves_it_closed)
{
    auto polygons = with(room_with_lamp(), box({1, 1, 1}, {0.5, 0.5, 0.5}, false, "red", "block"));
    polygons.push_back(rectangle({3, 3, 1}, {0.5, 0, 0}, {0, 0.5, 0.1}, "red", "plate"));
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    EXPECT_TRUE(loaded.scene.closed);
    EXPECT_TRUE(load(with(polygons, rectangle({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, "red"))).scene.closed)
        << "a plate outside gets no light";
    EXPECT_FALSE(load(with(polygons, rectangle({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, "lamp"))).scene.closed)
        << "a lamp outside lights the sky";
}

TEST(BuildScene, a_block_standing_on_the_floor_shares_its_foot)
{
    auto block = box({1, 1, 0}, {2, 1, 1}, false, "red", "block");
    block.erase(block.begin());  // no bottom
    const auto polygons = with(room_with_lamp(), block);
    for (const bool turn : {false, true}) {
        const LoadedScene loaded = load(polygons, {}, turn ? Placement(rotated) : Placement());
        expect_sound(loaded);
        EXPECT_TRUE(loaded.scene.closed) << "every foot edge is an edge of the floor's triangulation";
        EXPECT_EQ(count_of(loaded.scene, "red"), 5U);
        EXPECT_EQ(count_of(loaded.scene, "white"), 6U) << "the floor stays one surface";
        EXPECT_NEAR(total_area(loaded.scene, "white"), 16 - 2 + 15 + 48, 1e-6) << "but for what the block covers";
    }
}

TEST(BuildScene, a_plate_standing_inside_a_floor_polygon_is_an_edge_of_its_triangulation)
{
    const Vec3 a{1, 1, 0}, b{2, 1.5, 0};
    const std::vector<Polygon> polygons = {rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                                           lamp_above,
                                           {{a, b, b + Vec3{0, 0, 1}, a + Vec3{0, 0, 1}}, "red", "plate"}};
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    const Scene& scene = loaded.scene;
    int shared = 0;
    for (const SceneTriangle& t : scene.triangles) {
        if (scene.material_of(t.front.valid() ? t.front : t.back).name != "white") continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = scene.vertices[t.vertices[k]] + scene.center;
            const Vec3 q = scene.vertices[t.vertices[(k + 1) % 3]] + scene.center;
            if ((glm::distance(p, a) < 1e-12 && glm::distance(q, b) < 1e-12) ||
                (glm::distance(p, b) < 1e-12 && glm::distance(q, a) < 1e-12)) {
                ++shared;
            }
        }
    }
    EXPECT_EQ(shared, 2) << "one floor triangle on either side of the plate's foot";
}

TEST(BuildScene, t_junctions_do_not_leave_cracks)
{
    // One rectangle beside two smaller ones, each with vertices of its own.
    const std::vector<Polygon> polygons = {rectangle({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, "white"),
                                           rectangle({1, 0, 0}, {1, 0, 0}, {0, 0.7, 0}, "red"),
                                           rectangle({1, 0.7, 0}, {1, 0, 0}, {0, 1.3, 0}, "red"), lamp_above};
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.t_junctions, 1U);
    EXPECT_EQ(loaded.scene.surfaces.size(), 3U);
    EXPECT_EQ(loaded.report.welded_vertices, 4U);
}

TEST(BuildScene, faces_without_area_and_duplicates_are_dropped_and_counted)
{
    auto polygons = room_with_lamp();
    polygons.push_back({{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}});
    polygons.push_back({{{0, 0, 0}, {0, 0, 0}, {2, 2, 0}}});
    polygons.push_back(polygons[0]);
    std::rotate(polygons.back().corners.begin(), polygons.back().corners.begin() + 1, polygons.back().corners.end());
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.zero_area_faces, 2U);
    EXPECT_EQ(loaded.report.duplicate_faces, 1U);
    EXPECT_EQ(loaded.scene.surfaces.size(), 7U);
}

// Found by fuzzing: beyond the corner where it touches there is the inside of the block.
TEST(BuildScene, a_lamp_that_touches_a_block_from_outside_is_in_the_open)
{
    const Polygon lamp{{{1, 1, 1}, {0, 0.5, 1}, {0.5, 0, 1}}, "lamp", "lamp"};
    EXPECT_FALSE(load(with(box({1, 1, 0}, {1, 1, 2}, false), lamp)).scene.closed);
    EXPECT_FALSE(load(with(box({1, 1, 0}, {1, 1, 2}, true), lamp)).scene.closed);
    const Polygon inside{{{2, 2, 1}, {1.2, 1.5, 1}, {1.5, 1.2, 1}}, "lamp", "lamp"};
    EXPECT_TRUE(load(with(box({1, 1, 0}, {1, 1, 2}, true), inside)).scene.closed);
}

// Found by fuzzing: snapping put a corner of a chip off its plane, and a patch had four million times its area.
TEST(BuildScene, chips_narrower_than_snapping_are_no_surfaces)
{
    const auto polygons = with(box({3e-8, 0.5, 1.00000003}, {0.5, 2.0102, 1}, false),
                               {{{{0, 1, 2.000000001}, {0.6118, 1.5, 2.000000001}, {0.5, 2.00000003, 2.000000001}}},
                                rectangle({0.75, 0.75, 2}, {0, 0.5, 0}, {0.5, 0, 0}, "lamp")});
    SceneOptions options;
    options.all_two_sided = true;
    for (const bool turn : {false, true}) {
        const LoadedScene loaded = load(polygons, options, turn ? Placement(rotated) : Placement());
        for (const Surface& surface : loaded.scene.surfaces) EXPECT_GT(surface.area, 1e-3);
    }
}

TEST(BuildScene, needles_stay_and_are_counted)
{
    const LoadedScene loaded =
        load(with(room_with_lamp(), Polygon{{{1, 1, 1}, {2, 1, 1}, {2, 1 + 1e-6, 1}}, "red", "needle"}));
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.needles, 1U);
    // The area is 5e-7 m², with vertices exact to 1e-12 of the room.
    EXPECT_NEAR(total_area(loaded.scene, "red"), 5e-7, 1e-11);
}

TEST(BuildScene, a_flush_emitter_wins_over_the_ceiling_it_lies_in)
{
    const auto polygons =
        with(box({0, 0, 0}, {4, 4, 3}, true), rectangle({1, 1, 3}, {0, 1, 0}, {1, 0, 0}, "lamp", "lamp"));
    const LoadedScene loaded = load(polygons);
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.coplanar_overlaps, 1U);
    EXPECT_NEAR(total_area(loaded.scene, "lamp"), 1, 1e-12);
    EXPECT_NEAR(total_area(loaded.scene, "white"), 16 + 15 + 48, 1e-12);
    EXPECT_TRUE(loaded.scene.closed);
}

TEST(BuildScene, of_two_overlapping_faces_the_smaller_wins_in_any_order)
{
    const Polygon large = rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "white");
    const Polygon small = rectangle({1, 1, 0}, {1.5, 0, 0}, {0, 1.5, 0}, "red");
    const LoadedScene one = load({large, small, lamp_above}), other = load({lamp_above, small, large});
    expect_sound(one);
    EXPECT_EQ(one.report.coplanar_overlaps, 1U);
    EXPECT_NEAR(total_area(one.scene, "red"), 2.25, 1e-12);
    EXPECT_NEAR(total_area(one.scene, "white"), 3, 1e-12);
    expect_same_scene(one.scene, other.scene);
}

TEST(BuildScene, opposed_coincident_faces_are_two_sides_of_one_triangle)
{
    Polygon back = rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "red");
    std::reverse(back.corners.begin(), back.corners.end());
    const LoadedScene loaded = load({rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, "white"), back, lamp_above});
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.opposed_pairs, 2U);
    EXPECT_EQ(loaded.report.duplicate_faces, 0U);
    EXPECT_EQ(loaded.scene.surfaces.size(), 3U);
}

TEST(BuildScene, a_two_sided_material_gives_two_surfaces_back_to_back)
{
    SceneOptions options;
    options.two_sided = {"red"};
    const LoadedScene loaded = load(with(room_with_lamp(), rectangle({1, 1, 1}, {1, 0, 0}, {0, 1, 0}, "red")), options);
    expect_sound(loaded);
    EXPECT_EQ(count_of(loaded.scene, "red"), 2U);
    EXPECT_NEAR(total_area(loaded.scene, "red"), 2, 1e-12);
    EXPECT_TRUE(loaded.scene.closed);
    options.all_two_sided = true;
    EXPECT_FALSE(load(room_with_lamp(), options).scene.closed) << "the lamp shines upward, too";
}

TEST(BuildScene, edges_that_more_than_two_faces_share_are_counted)
{
    const Vec3 edge{0, 0, 2};
    const LoadedScene loaded = load({rectangle({0, 0, 0}, edge, {1, 0, 0}), rectangle({0, 0, 0}, edge, {0, 1, 0}),
                                     rectangle({0, 0, 0}, edge, {-1, -1, 0}), lamp_above});
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.nonmanifold_edges, 1U);
    EXPECT_EQ(loaded.scene.surfaces.size(), 4U);
}

TEST(BuildScene, a_bow_tie_is_filled_and_counted)
{
    const LoadedScene loaded = load({{{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, "red", "tie"}, lamp_above});
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.self_crossing_faces, 1U);
    EXPECT_NEAR(total_area(loaded.scene, "red"), 2, 1e-12) << "two triangles of 1 m²";
}

TEST(BuildScene, faces_that_pierce_each_other_are_counted)
{
    const LoadedScene loaded =
        load(with(room_with_lamp(), {rectangle({1, 1, 1}, {1, 0, 0}, {0, 1, 0}, "red"),
                                     rectangle({1.5, 1.2, 0.5}, {0, 0.5, 0}, {0, 0, 1}, "red")}));
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.crossing_faces, 1U);
    EXPECT_EQ(load(room_with_lamp()).report.crossing_faces, 0U);
}

TEST(BuildScene, polygons_that_are_not_planar_become_triangles)
{
    const Polygon bent{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0.3}, {0, 2, 0}}, "red", "bent"};
    const Polygon pentagon{{{5, 0, 0}, {7, 0, 0}, {7, 2, 0.3}, {6, 3, 0}, {5, 2, 0.1}}, "red", "bent"};
    const LoadedScene loaded = load({bent, pentagon, lamp_above});
    expect_sound(loaded);
    EXPECT_EQ(loaded.report.nonplanar_faces, 2U);
    EXPECT_EQ(count_of(loaded.scene, "red"), 5U);
}

TEST(BuildScene, an_l_shaped_polygon_keeps_its_shape)
{
    const Polygon ell{{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, "red", "ell"};
    const LoadedScene loaded = load({ell, lamp_above}, {}, rotated);
    expect_sound(loaded);
    EXPECT_NEAR(total_area(loaded.scene, "red"), 5, 1e-12 * 5);
    for (const Surface& surface : loaded.scene.surfaces) {
        EXPECT_EQ(surface.loops[0].size(), surface.area > 2 ? 6U : 4U);
    }
}

TEST(BuildScene, squares_that_meet_at_corners_only_are_surfaces_of_their_own)
{
    std::vector<Polygon> board{lamp_above};
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 4; ++k) {
            board.push_back(rectangle({i, k, 0}, {1, 0, 0}, {0, 1, 0}, (i + k) % 2 ? "white" : "red"));
        }
    }
    const LoadedScene loaded = load(board);
    expect_sound(loaded);
    EXPECT_EQ(loaded.scene.surfaces.size(), 17U);
}

// A patch that reached under the wall would carry light through it.
TEST(BuildScene, a_floor_that_two_sealed_rooms_share_is_two_surfaces)
{
    const auto one = box({0, 0, 0}, {1, 1, 1}, true, "red"), other = box({1, 0, 0}, {1, 1, 1}, true, "red");
    const Polygon lamp = rectangle({.4, .4, .8}, {0, .2, 0}, {.2, 0, 0}, "lamp");
    for (const Placement& place : {Placement{}, Placement{rotated}}) {
        const LoadedScene rooms = load(with(with(one, other), lamp), {}, place);
        expect_sound(rooms);
        EXPECT_EQ(count_of(rooms.scene, "red"), 12U);
        // A wall with a gap beside it seals nothing: the floor stays one surface.
        const Polygon screen = rectangle({1, 0, 0}, {0, .9, 0}, {0, 0, 1}, "red");
        const LoadedScene hall = load(with(with(box({0, 0, 0}, {2, 1, 1}, true, "red"), screen), lamp), {}, place);
        expect_sound(hall);
        EXPECT_EQ(count_of(hall.scene, "red"), 7U);
    }
}

TEST(BuildScene, holes_that_touch_the_border_in_a_vertex_are_loops_of_their_own)
{
    // A frame of 8 squares round a hole, and a diamond cut whose corner touches the outer edge.
    const std::vector<Polygon> pieces = {{{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, "red"},
                                         {{{2, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}}, "red"},
                                         {{{0, 3, 0}, {1, 3, 0}, {3, 3, 0}, {4, 3, 0}, {4, 4, 0}, {0, 4, 0}}, "red"},
                                         lamp_above};
    const LoadedScene loaded = load(pieces);
    expect_sound(loaded);
    ASSERT_EQ(count_of(loaded.scene, "red"), 1U);
    for (const Surface& surface : loaded.scene.surfaces) {
        if (surface.area < 2) continue;
        ASSERT_EQ(surface.loops.size(), 2U);
        EXPECT_EQ(surface.loops[0].size(), 5U) << "the square's corners and the vertex the hole touches";
        EXPECT_EQ(surface.loops[1].size(), 5U);
    }
}

TEST(BuildScene, the_order_of_faces_does_not_matter)
{
    auto polygons = with(triangulated(room_with_lamp()), box({1, 1, 0}, {2, 1, 1}, false, "red", "block"));
    polygons.push_back(rectangle({2.5, 0.2, 0}, {0.3, 0, 0}, {0, 0.4, 0}, "red", "mat"));
    polygons.push_back(rectangle({2.6, 0.3, 0}, {0.3, 0, 0}, {0, 0.4, 0}, "lamp", "glow"));
    const LoadedScene straight = load(polygons, {}, rotated);
    expect_sound(straight);
    std::mt19937 random(7);
    for (int round = 0; round < 5; ++round) {
        std::shuffle(polygons.begin(), polygons.end(), random);
        for (Polygon& p : polygons) std::rotate(p.corners.begin(), p.corners.begin() + 1, p.corners.end());
        expect_same_scene(straight.scene, load(polygons, {}, rotated).scene);
    }
}

TEST(BuildScene, scale_and_offset_change_nothing)
{
    auto polygons = with(room_with_lamp(), box({1, 1, 0}, {2, 1, 1}, false, "red", "block"));
    const LoadedScene plain = load(polygons);
    struct Change {
        double scale;
        Vec3 offset;
        double tolerance;  ///< relative, on areas: what doubles resolve at that offset
    };
    const Vec3 far{5e7, -3e7, 4e7};
    for (const Change& change : {Change{1e-6, {}, 1e-12}, {1e6, {}, 1e-12}, {1, far, 1e-7}, {1e-3, 1e-3 * far, 1e-7}}) {
        const LoadedScene other = load(polygons, {}, [&](const Vec3& p) { return change.scale * p + change.offset; });
        expect_sound(other);
        EXPECT_TRUE(other.scene.closed);
        ASSERT_EQ(other.scene.surfaces.size(), plain.scene.surfaces.size());
        ASSERT_EQ(other.scene.triangles.size(), plain.scene.triangles.size());
        for (std::size_t s = 0; s < plain.scene.surfaces.size(); ++s) {
            const Surface &a = plain.scene.surfaces[s], &b = other.scene.surfaces[s];
            EXPECT_EQ(a.loops, b.loops);
            EXPECT_NEAR(b.area / (change.scale * change.scale), a.area, change.tolerance * a.area);
        }
    }
}

TEST(BuildScene, units_scale_the_file_and_coordinates_are_recentred)
{
    SceneOptions options;
    options.unit = 0.01;
    const Scene scene = load(room_with_lamp(), options).scene;
    EXPECT_NEAR(scene.diameter, 0.01 * std::sqrt(16 + 16 + 9), 1e-15);
    EXPECT_NEAR(glm::distance(scene.center, Vec3{0.02, 0.02, 0.015}), 0, 1e-15);
    for (const Vec3& v : scene.vertices) EXPECT_LE(glm::length(v), 0.5 * scene.diameter * (1 + 1e-12));
}

TEST(BuildScene, axis_aligned_planes_have_axes_for_frames)
{
    for (const Surface& surface :
         load(triangulated(room_with_lamp()), {}, [](const Vec3& p) { return p * 0.3; }).scene.surfaces) {
        for (const Vec3& axis : {surface.frame.u, surface.frame.v, surface.frame.n}) {
            EXPECT_EQ(std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z), 1.0);
        }
    }
}

TEST(BuildScene, random_blocks_through_one_another_stay_sound)
{
    std::mt19937 random(11);
    std::uniform_int_distribution<int> step(0, 6), kind(0, 2);
    for (int round = 0; round < 12; ++round) {
        // Corners on a coarse grid: many faces share planes, edges and corners.
        std::vector<Polygon> polygons{lamp_above};
        for (int b = 0; b < 8; ++b) {
            const Vec3 low{step(random), step(random), step(random)};
            const Vec3 size{1 + step(random) % 3, 1 + step(random) % 3, 1 + step(random) % 3};
            const std::string material = std::array{"white", "red", "lamp"}[static_cast<std::size_t>(kind(random))];
            polygons = with(polygons, box(low, size, kind(random) == 0, material));
        }
        SceneOptions options;
        options.all_two_sided = round % 3 == 0;
        const LoadedScene plain = load(polygons, options);
        const LoadedScene turned = load(polygons, options, rotated);
        expect_sound(plain);
        expect_sound(turned);
        EXPECT_EQ(plain.scene.surfaces.size(), turned.scene.surfaces.size());
        EXPECT_EQ(plain.scene.closed, turned.scene.closed);
        EXPECT_EQ(plain.report.coplanar_overlaps, turned.report.coplanar_overlaps);
    }
}

TEST(BuildScene, five_thousand_polygons_are_read_in_near_linear_time)
{
    std::vector<Polygon> polygons = room_with_lamp();
    for (int i = 0; i < 30; ++i) {
        for (int k = 0; k < 33; ++k) {
            auto block =
                box({0.05 + 0.12 * i, 0.05 + 0.11 * k, 0}, {0.06, 0.05, 0.1 + 0.01 * (i + k)}, false, "red", "block");
            block.erase(block.begin());
            polygons = with(std::move(polygons), block);
        }
    }
    const auto start = std::chrono::steady_clock::now();
    const LoadedScene loaded = load(polygons, {}, rotated);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    expect_sound(loaded);
    EXPECT_TRUE(loaded.scene.closed);
    EXPECT_EQ(loaded.scene.surfaces.size(), 7U + 5 * 990);
    // 0.4 s on an idle core; anything that isn't near-linear takes minutes.
    EXPECT_LT(seconds, 10);
}
