#include "meshing/patch_mesh.h"

#include "tests/meshing/flat_scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// Two squares, one metre apart in height.
Scene two_squares()
{
    Scene scene = flat_scene({rectangle_loop(0, 0, 1, 1)});
    Surface upper = scene.surfaces[0];
    upper.frame.origin.z = 1;
    for (std::uint32_t& v : upper.loops[0]) v += 4;
    for (std::size_t k = 0; k < 4; ++k) scene.vertices.push_back(scene.vertices[k] + Vec3(0, 0, 1));
    scene.surfaces.push_back(upper);
    return scene;
}

/// The lower square about its middle in four patches, the upper one in two.
PatchMeshArrays sound_arrays()
{
    PatchMeshArrays arrays;
    arrays.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0},
                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    arrays.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {5, 6, 7}, {5, 7, 8}};
    arrays.vertex_surface.assign(9, SurfaceId(std::size_t{0}));
    std::fill(arrays.vertex_surface.begin() + 5, arrays.vertex_surface.end(), SurfaceId(std::size_t{1}));
    arrays.patch_surface.assign(6, SurfaceId(std::size_t{0}));
    std::fill(arrays.patch_surface.begin() + 4, arrays.patch_surface.end(), SurfaceId(std::size_t{1}));
    return arrays;
}

void expect_refused(const std::function<void(PatchMeshArrays&)>& spoil)
{
    PatchMeshArrays arrays = sound_arrays();
    spoil(arrays);
    EXPECT_THROW(PatchMesh(two_squares(), std::move(arrays)), std::invalid_argument);
}

}  // namespace

TEST(PatchMesh, knows_areas_edges_and_ranges)
{
    const PatchMesh mesh(two_squares(), sound_arrays());
    ASSERT_EQ(mesh.patch_count(), 6U);
    ASSERT_EQ(mesh.vertex_count(), 9U);
    EXPECT_EQ(mesh.surface_count(), 2U);
    EXPECT_EQ(mesh.patches_of(SurfaceId(std::size_t{1})).first, 4U);
    EXPECT_EQ(mesh.vertices_of(SurfaceId(std::size_t{0})).size(), 5U);
    EXPECT_EQ(mesh.area(PatchId(std::size_t{0})), 0.25);
    EXPECT_EQ(mesh.area(PatchId(std::size_t{4})), 0.5);
    EXPECT_EQ(mesh.longest_edge(PatchId(std::size_t{0})), 1);
    EXPECT_DOUBLE_EQ(mesh.longest_edge(PatchId(std::size_t{4})), std::sqrt(2.0));
    EXPECT_EQ(mesh.plane_position(VertexId(std::size_t{7})), Vec2(1, 1));
    EXPECT_NEAR(glm::distance(mesh.centroid(PatchId(std::size_t{0})), Vec3(0.5, 0.5 / 3, 0)), 0, 1e-15);
}

TEST(PatchMesh, neighbours_follow_the_corners)
{
    const PatchMesh mesh(two_squares(), sound_arrays());
    const auto id = [](std::size_t i) { return PatchId(i); };
    EXPECT_EQ(mesh.neighbours(id(0)), (std::array{PatchId(), id(1), id(3)}));
    EXPECT_EQ(mesh.neighbours(id(2)), (std::array{PatchId(), id(3), id(1)}));
    EXPECT_EQ(mesh.neighbours(id(4)), (std::array{PatchId(), PatchId(), id(5)}));
    EXPECT_EQ(mesh.patches_around(VertexId(std::size_t{4})), (std::vector{id(0), id(1), id(2), id(3)}));
    EXPECT_EQ(mesh.patches_around(VertexId(std::size_t{7})), (std::vector{id(4), id(5)}));
    for (const VertexId v : mesh.vertices()) EXPECT_EQ(mesh.on_border(v), v.value != 4) << v.value;
}

TEST(PatchMesh, a_moved_mesh_is_whole)
{
    PatchMesh mesh(two_squares(), sound_arrays());
    PatchMesh other = std::move(mesh);
    mesh = std::move(other);
    EXPECT_EQ(mesh.neighbours(PatchId(std::size_t{5}))[0], PatchId(std::size_t{4}));
}

TEST(PatchMesh, indices_past_the_end_are_refused)
{
    expect_refused([](auto& a) { a.triangles[0][1] = 9; });
    expect_refused([](auto& a) { a.triangles[5][2] = std::numeric_limits<std::uint32_t>::max(); });
}

TEST(PatchMesh, one_surface_is_needed_for_each_patch_and_vertex)
{
    expect_refused([](auto& a) { a.patch_surface.pop_back(); });
    expect_refused([](auto& a) { a.vertex_surface.pop_back(); });
    expect_refused([](auto& a) { a.patch_surface.emplace_back(std::size_t{1}); });
}

TEST(PatchMesh, surfaces_out_of_order_or_past_the_end_are_refused)
{
    // Consistent otherwise: the two surfaces change places.
    expect_refused([](auto& a) {
        for (auto* surfaces : {&a.patch_surface, &a.vertex_surface}) {
            for (SurfaceId& s : *surfaces) s = SurfaceId(std::size_t{1} - s.value);
        }
    });
    expect_refused([](auto& a) {
        for (auto* surfaces : {&a.patch_surface, &a.vertex_surface}) {
            for (SurfaceId& s : *surfaces) s = SurfaceId(std::size_t{s.value} + 1);
        }
    });
    expect_refused([](auto& a) { a.vertex_surface.back() = SurfaceId(); });
}

TEST(PatchMesh, a_triangle_of_two_surfaces_is_refused)
{
    expect_refused([](auto& a) { a.triangles[0][0] = 5; });
}

TEST(PatchMesh, triangles_without_area_or_turned_over_are_refused)
{
    expect_refused([](auto& a) { std::swap(a.triangles[2][0], a.triangles[2][1]); });
    expect_refused([](auto& a) { a.triangles[1] = {1, 1, 4}; });
    expect_refused([](auto& a) { a.triangles[1] = {0, 4, 2}; });
    expect_refused([](auto& a) { a.positions[4].x = std::numeric_limits<double>::quiet_NaN(); });
}

TEST(PatchMesh, an_edge_with_two_patches_on_one_side_is_refused)
{
    expect_refused([](auto& a) { a.triangles[3] = {0, 1, 2}; });
    expect_refused([](auto& a) { a.triangles[5] = a.triangles[4]; });
}

TEST(PatchMesh, patches_that_meet_in_a_vertex_only_are_refused)
{
    expect_refused([](auto& a) {
        a.triangles.erase(a.triangles.begin() + 3);
        a.triangles.erase(a.triangles.begin() + 1);
        a.patch_surface.erase(a.patch_surface.begin(), a.patch_surface.begin() + 2);
    });
}
