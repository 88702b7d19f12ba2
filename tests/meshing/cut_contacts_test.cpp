#include "tests/meshing/line_checks.h"

#include <gtest/gtest.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

const PlaneLoops unit_square{rectangle_loop(0, 0, 1, 1)};

/// Contact lines in the unit square, finely meshed.
LinedSurface with_contacts(const std::vector<std::array<Vec2, 2>>& contacts, const PlaneFrame& frame = {})
{
    LinedSurface surface(unit_square, frame);
    std::vector<SurfaceLine> lines;
    for (const auto& [a, b] : contacts) lines.push_back(line_from(a, b, LineKind::contact));
    surface.insert(lines);
    const TargetEdge target = [](const Vec2&) { return 0.15; };
    surface.triangulation = refine_triangulation(surface.plane(), surface.triangulation, target, 0);
    expect_sound_mesh(surface.scene, surface.mesh());
    return surface;
}

/// How many vertices a mesh has at a place.
std::size_t copies(const LinedSurface& surface, const Vec2& place)
{
    const PatchMesh mesh = surface.mesh();
    std::size_t count = 0;
    for (const VertexId v : mesh.vertices()) count += glm::distance(mesh.plane_position(v), place) < 1e-7;
    return count;
}

bool is_edge(const PatchMesh& mesh, std::uint32_t from, std::uint32_t to)
{
    for (const PatchId p : mesh.patches_around(VertexId(from))) {
        const auto c = mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k)
            if (c[k].value == from && c[(k + 1) % 3].value == to) return true;
    }
    return false;
}

/// Patches on the left of each line have its left copies, those on its right the others; at the same places.
void expect_sides(const PatchMesh& mesh)
{
    for (const MeshLine& line : mesh.lines()) {
        // A patch has its edges counter-clockwise: that which runs along the line is on its left.
        EXPECT_TRUE(is_edge(mesh, line.left[0], line.left[1]));
        EXPECT_TRUE(is_edge(mesh, line.right[1], line.right[0]));
        if (line.kind != LineKind::contact) continue;
        EXPECT_FALSE(is_edge(mesh, line.left[1], line.left[0]));
        EXPECT_FALSE(is_edge(mesh, line.right[0], line.right[1]));
    }
}

/// Sewn up again it is what it was before.
void expect_sewn(const LinedSurface& surface)
{
    const SurfaceTriangulation sewn = triangulation_of(surface.mesh(), only_surface);
    EXPECT_EQ(sewn.positions, surface.triangulation.positions);
    EXPECT_EQ(sewn.triangles, surface.triangulation.triangles);
    ASSERT_EQ(sewn.lines.size(), surface.triangulation.lines.size());
    for (std::size_t i = 0; i < sewn.lines.size(); ++i) {
        EXPECT_EQ(sewn.lines[i].vertices, surface.triangulation.lines[i].vertices);
        EXPECT_EQ(sewn.lines[i].kind, surface.triangulation.lines[i].kind);
    }
}

}  // namespace

TEST(CutContacts, a_line_inside_has_two_vertices_at_each_of_its_points_ends_included)
{
    for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
        const LinedSurface surface = with_contacts({{Vec2(0.3, 0.5), Vec2(0.7, 0.45)}}, frame);
        const PatchMesh mesh = surface.mesh();
        std::size_t on_line = 0;
        for (const auto& line : surface.triangulation.lines) {
            EXPECT_EQ(copies(surface, surface.at(line.vertices[0])), 2U);
            EXPECT_EQ(copies(surface, surface.at(line.vertices[1])), 2U);
            ++on_line;
        }
        EXPECT_GE(on_line, 3U);
        // Beyond each end the cut goes on along one edge.
        EXPECT_EQ(std::ranges::count_if(mesh.lines(), [](const MeshLine& line) { return line.beyond; }), 2);
        EXPECT_EQ(mesh.lines().size(), on_line + 2);
        expect_sides(mesh);
        expect_sewn(surface);
    }
}

TEST(CutContacts, the_sides_do_not_meet)
{
    const LinedSurface surface = with_contacts({{Vec2(0.3, 0.5), Vec2(0.7, 0.5)}});
    const PatchMesh mesh = surface.mesh();
    for (const MeshLine& line : mesh.lines()) {
        if (line.beyond) continue;
        const double way =
            mesh.plane_position(VertexId(line.left[1])).x - mesh.plane_position(VertexId(line.left[0])).x;
        for (const std::uint32_t v : line.left)
            for (const PatchId p : mesh.patches_around(VertexId(v))) {
                double above = 0;
                for (const VertexId c : mesh.corners(p)) above += mesh.plane_position(c).y - 0.5;
                // Past the ends a patch may reach over the line's prolongation.
                double least = 1, most = 0;
                for (const VertexId c : mesh.corners(p)) {
                    least = std::min(least, mesh.plane_position(c).x);
                    most = std::max(most, mesh.plane_position(c).x);
                }
                if (least > 0.3 - 1e-9 && most < 0.7 + 1e-9) {
                    EXPECT_GT(above * way, 0);
                }
            }
    }
}

TEST(CutContacts, other_lines_are_not_cut)
{
    LinedSurface surface(unit_square);
    const std::vector<SurfaceLine> lines{line_from({0.2, 0.5}, {0.8, 0.5}, LineKind::ev)};
    surface.insert(lines);
    const PatchMesh mesh = surface.mesh();
    EXPECT_EQ(mesh.vertex_count(), surface.triangulation.positions.size());
    ASSERT_EQ(mesh.lines().size(), 1U);
    EXPECT_EQ(mesh.lines()[0].left, mesh.lines()[0].right);
    expect_sewn(surface);
}

TEST(CutContacts, where_two_cross_there_are_four_vertices)
{
    const LinedSurface surface = with_contacts({{Vec2(0.2, 0.5), Vec2(0.8, 0.5)}, {Vec2(0.45, 0.2), Vec2(0.45, 0.9)}});
    EXPECT_EQ(copies(surface, {0.45, 0.5}), 4U);
    EXPECT_EQ(copies(surface, {0.2, 0.5}), 2U);
    expect_sides(surface.mesh());
    expect_sewn(surface);
}

TEST(CutContacts, where_one_ends_at_another_there_are_three)
{
    const LinedSurface surface = with_contacts({{Vec2(0.2, 0.5), Vec2(0.8, 0.5)}, {Vec2(0.45, 0.5), Vec2(0.45, 0.9)}});
    EXPECT_EQ(copies(surface, {0.45, 0.5}), 3U);
    EXPECT_EQ(copies(surface, {0.45, 0.9}), 2U);
    expect_sides(surface.mesh());
    expect_sewn(surface);
}

TEST(CutContacts, on_the_border_an_end_has_two)
{
    const LinedSurface surface = with_contacts({{Vec2(0.4, 0), Vec2(0.4, 0.6)}});
    EXPECT_EQ(copies(surface, {0.4, 0}), 2U);
    EXPECT_EQ(copies(surface, {0.4, 0.6}), 2U);
    const LinedSurface across = with_contacts({{Vec2(0, 0.5), Vec2(1, 0.3)}});
    EXPECT_EQ(copies(across, {0, 0.5}), 2U);
    EXPECT_EQ(copies(across, {1, 0.3}), 2U);
    for (const LinedSurface* each : {&surface, &across}) {
        expect_sides(each->mesh());
        expect_sewn(*each);
    }
}

TEST(CutContacts, corners_and_rings_are_cut_all_round)
{
    const Vec2 a{0.3, 0.3}, b{0.7, 0.3}, c{0.7, 0.6}, d{0.3, 0.6};
    const LinedSurface ring = with_contacts({{a, b}, {b, c}, {c, d}, {d, a}});
    const LinedSurface corner = with_contacts({{a, b}, {b, c}});
    for (const Vec2& q : {a, b, c}) {
        EXPECT_EQ(copies(ring, q), 2U);
        EXPECT_EQ(copies(corner, q), 2U);
    }
    EXPECT_TRUE(std::ranges::none_of(ring.mesh().lines(), [](const MeshLine& line) { return line.beyond; }));
    for (const LinedSurface* each : {&ring, &corner}) {
        expect_sides(each->mesh());
        expect_sewn(*each);
    }
}

TEST(CutContacts, short_lines_near_each_other_and_the_border)
{
    const LinedSurface surface = with_contacts({{Vec2(0.5, 0.5), Vec2(0.5001, 0.5)},
                                                {Vec2(0.5002, 0.5), Vec2(0.5003, 0.5)},
                                                {Vec2(0.001, 0.2), Vec2(0.002, 0.2)},
                                                {Vec2(0.999, 0.999), Vec2(0.9995, 0.9995)}});
    EXPECT_EQ(copies(surface, {0.5001, 0.5}), 2U);
    EXPECT_EQ(copies(surface, {0.5002, 0.5}), 2U);
    EXPECT_EQ(copies(surface, {0.001, 0.2}), 2U);
    expect_sides(surface.mesh());
    expect_sewn(surface);
}

TEST(CutContacts, random_contacts_and_other_lines_are_sewn_up_to_what_they_were)
{
    std::mt19937 random(3);
    const auto draw = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE(round);
        LinedSurface surface(unit_square, round % 2 == 0 ? PlaneFrame{} : tilted_frame());
        std::vector<SurfaceLine> lines;
        for (int i = 0; i < 3 + round; ++i)
            lines.push_back(
                line_from({draw(), draw()}, {draw(), draw()}, i % 3 == 0 ? LineKind::plane : LineKind::contact));
        surface.insert(lines);
        expect_sound_mesh(surface.scene, surface.mesh());
        expect_sides(surface.mesh());
        expect_sewn(surface);
    }
}

// Refinement goes over sewn surfaces and cuts them again: both sides stay together.
TEST(CutContacts, refined_sides_stay_conforming)
{
    const Scene scene = cornell_box();
    PatchMesh mesh = triangulate(scene, {.max_elements = 400}, crosses(scene));
    for (std::uint32_t round = 0; round < 4; ++round) {
        mesh = refine(scene, mesh, random_plan(mesh, 0.4, round), {}).mesh;
        expect_sound_mesh(scene, mesh);
        expect_sides(mesh);
        EXPECT_GT(std::ranges::count_if(mesh.lines(), [](const MeshLine& line) { return line.beyond; }), 20);
    }
}
