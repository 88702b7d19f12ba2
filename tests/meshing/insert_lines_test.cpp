#include "tests/meshing/line_checks.h"

#include <gtest/gtest.h>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

const PlaneLoops unit_square{rectangle_loop(0, 0, 1, 1)};

/// Lines go through what is nearer than the merging distance: each such point may move them by as much, and they may
/// bend again at the next. A few times that is what one line on its own, or few, may show.
constexpr double bent = 3 * line_merge;

/// Hundreds of lines bend at more points; the most that was seen is 1.7 times the merging distance.
constexpr double bent_often = 5 * line_merge;

LinedSurface with_lines(const PlaneLoops& loops, const std::vector<SurfaceLine>& lines, const PlaneFrame& frame = {})
{
    LinedSurface surface(loops, frame);
    const SurfaceTriangulation before = surface.triangulation;
    surface.insert(lines);
    expect_sound_surface(surface, before);
    return surface;
}

void expect_lines(const LinedSurface& surface, const std::vector<SurfaceLine>& lines, double tolerance = bent)
{
    for (const SurfaceLine& line : lines) EXPECT_LE(distance_to_lines(surface, line), tolerance);
}

/// Edges that end at a place.
std::size_t lines_at(const LinedSurface& surface, const Vec2& place)
{
    std::size_t count = 0;
    for (const auto& edge : surface.triangulation.lines)
        for (const std::uint32_t v : edge.vertices)
            count += glm::distance(surface.at(v), place) < 1e-5 * surface.scene.diameter;
    return count;
}

bool is_inside(const PlaneLoops& loops, const Vec2& q, double margin)
{
    bool inside = false;
    for (const PlaneLoop& loop : loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
            if (distance_to_segment(q, a, b) < margin) return false;
            if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
        }
    return inside;
}

std::vector<SurfaceLine> random_lines(const PlaneLoops& loops, std::size_t count, std::uint32_t seed)
{
    Vec2 low = loops[0][0], high = low;
    for (const Vec2& q : loops[0]) {
        low = glm::min(low, q);
        high = glm::max(high, q);
    }
    std::mt19937 random(seed);
    const auto draw = [&] { return static_cast<double>(random()) / 4294967296.0; };
    const auto place = [&] { return low + Vec2(-0.1 + 1.2 * draw(), -0.1 + 1.2 * draw()) * (high - low); };
    std::vector<SurfaceLine> lines;
    while (lines.size() < count) {
        const auto kind = static_cast<LineKind>(random() % line_kinds.size());
        Vec2 a = place(), b = place();
        switch (random() % 4) {
        case 0:  // along an axis, on a grid: many coincide
            a = low + glm::round(20.0 * (a - low) / (high - low)) / 20.0 * (high - low);
            b = random() % 2 == 0 ? Vec2(a.x, b.y) : Vec2(b.x, a.y);
            break;
        case 1:  // from where another one starts
            if (!lines.empty()) a = lines[random() % lines.size()].start;
            break;
        case 2:  // along another one, nearly
            if (!lines.empty()) {
                const SurfaceLine& other = lines[random() % lines.size()];
                a = other.start + draw() * (other.end - other.start);
                b = other.end + std::pow(10, -5 - 5 * draw()) * (high - low);
            }
            break;
        default:
            break;
        }
        if (glm::distance(a, b) > 0) lines.push_back(line_from(a, b, kind));
    }
    return lines;
}

/// All that is inside the polygon is there, no place of it further off than `most` of the diameter.
void expect_inside_parts(const LinedSurface& surface, const PlaneLoops& loops, const std::vector<SurfaceLine>& lines,
                         double most)
{
    double farthest = 0;
    for (const SurfaceLine& line : lines)
        farthest = std::max(farthest, distance_to_lines(surface, line, [&](const Vec2& q) {
                                return is_inside(loops, q, 1e-5 * surface.scene.diameter);
                            }));
    EXPECT_LE(farthest, most);
}

}  // namespace

TEST(InsertLines, one_line_is_one_edge)
{
    for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
        const SurfaceLine line = line_from({0.2, 0.3}, {0.9, 0.6}, LineKind::ve);
        const LinedSurface surface = with_lines(unit_square, {line}, frame);
        ASSERT_EQ(surface.triangulation.lines.size(), 1U);
        EXPECT_EQ(surface.triangulation.lines[0].kind, LineKind::ve);
        EXPECT_EQ(surface.triangulation.positions.size(), 6U);
        // Ends are where they were asked for, but for meshing's rounding.
        expect_lines(surface, {line}, 2e-9);
        EXPECT_NEAR(length_of_lines(surface), glm::distance(line.start, line.end), 1e-8);
    }
}

TEST(InsertLines, no_lines_change_nothing)
{
    LinedSurface surface(unit_square);
    const SurfaceTriangulation before = surface.triangulation;
    surface.insert({});
    EXPECT_EQ(surface.triangulation.triangles.size(), before.triangles.size());
    EXPECT_EQ(surface.triangulation.positions.size(), before.positions.size());
    EXPECT_TRUE(surface.triangulation.lines.empty());
}

TEST(InsertLines, crossing_lines_share_a_vertex)
{
    const std::vector<SurfaceLine> lines{line_from({0.1, 0.2}, {0.9, 0.8}), line_from({0.3, 0.9}, {0.6, 0.1})};
    const LinedSurface surface = with_lines(unit_square, lines);
    EXPECT_EQ(surface.triangulation.lines.size(), 4U);
    EXPECT_EQ(surface.triangulation.positions.size(), 9U);
    expect_lines(surface, lines, 5e-9);
}

TEST(InsertLines, a_grid_of_lines_crosses_at_its_own_coordinates)
{
    std::vector<SurfaceLine> lines;
    for (int i = 1; i < 10; ++i) {
        lines.push_back(line_from({0.1 * i, 0.03}, {0.1 * i, 0.97}));
        lines.push_back(line_from({0.03, 0.1 * i}, {0.97, 0.1 * i}, LineKind::contact));
    }
    lines.push_back(line_from({0.05, 0.05}, {0.95, 0.95}));
    const LinedSurface surface = with_lines(unit_square, lines);
    expect_lines(surface, lines, 5e-9);
    EXPECT_EQ(surface.triangulation.positions.size(), 4U + 81 + 36 + 2);
    std::set<double> xs, ys;
    for (std::uint32_t v = 0; v < surface.triangulation.positions.size(); ++v) {
        const Vec2 q = surface.at(v);
        xs.insert(q.x);
        ys.insert(q.y);
    }
    // Nine lines, the ends of the others, the border and the ends of the diagonal: no coordinate twice but for
    // rounding.
    EXPECT_EQ(xs.size(), 9U + 2 + 2 + 2);
    EXPECT_EQ(ys.size(), 9U + 2 + 2 + 2);
}

TEST(InsertLines, lines_that_overlap_are_one_of_the_lowest_kind)
{
    const std::vector<SurfaceLine> lines{
        line_from({0.1, 0.5}, {0.6, 0.5}, LineKind::ve), line_from({0.9, 0.5}, {0.4, 0.5}, LineKind::contact),
        line_from({0.2, 0.5}, {0.3, 0.5}, LineKind::ev), line_from({0.1, 0.5}, {0.6, 0.5}, LineKind::plane)};
    const LinedSurface surface = with_lines(unit_square, lines);
    expect_lines(surface, lines, 2e-9);
    EXPECT_NEAR(length_of_lines(surface), 0.8, 1e-8);
    for (const auto& edge : surface.triangulation.lines) {
        const double x = 0.5 * (surface.at(edge.vertices[0]).x + surface.at(edge.vertices[1]).x);
        EXPECT_EQ(edge.kind, x > 0.4 ? LineKind::contact : x > 0.2 && x < 0.3 ? LineKind::ev : LineKind::ve) << x;
    }
}

TEST(InsertLines, nearly_coincident_lines_are_one)
{
    for (const double apart : {1e-7, 1e-9, 1e-12, 1e-16}) {
        SCOPED_TRACE(apart);
        const double d = apart * std::numbers::sqrt2;
        for (const double slant : {0.0, 0.3}) {
            const std::vector<SurfaceLine> lines{line_from({0.1, 0.2}, {0.9, 0.2 + slant}),
                                                 line_from({0.1, 0.2 + d}, {0.9, 0.2 + slant + d}),
                                                 line_from({0.3, 0.2 + 0.25 * slant - d}, {0.7, 0.2 + 0.75 * slant})};
            const LinedSurface surface = with_lines(unit_square, lines);
            expect_lines(surface, lines);
            EXPECT_NEAR(length_of_lines(surface), glm::distance(lines[0].start, lines[0].end), 1e-5);
        }
    }
}

TEST(InsertLines, lines_further_apart_than_merging_stay_two)
{
    for (const double apart : {1e-5, 1e-4}) {
        const double d = apart * std::numbers::sqrt2;
        const std::vector<SurfaceLine> lines{line_from({0.1, 0.2}, {0.9, 0.2}),
                                             line_from({0.1, 0.2 + d}, {0.9, 0.2 + d})};
        EXPECT_NEAR(length_of_lines(with_lines(unit_square, lines)), 1.6, 1e-5);
    }
}

TEST(InsertLines, ends_at_vertices_or_near_them_are_the_vertices)
{
    for (const double off : {0.0, 1e-9, 1e-7, 1e-6}) {
        SCOPED_TRACE(off);
        const LinedSurface surface =
            with_lines(unit_square, {line_from({off, off}, {1 - off, 1 - off}), line_from({1, off}, {off, 1})});
        EXPECT_EQ(surface.triangulation.positions.size(), 5U);
        EXPECT_EQ(surface.triangulation.lines.size(), 4U);
    }
}

TEST(InsertLines, a_line_past_the_end_of_another_goes_through_it)
{
    const Vec2 end{0.5, 0.5 + 1e-6};
    const LinedSurface surface =
        with_lines(unit_square, {line_from({0.5, 0.9}, end), line_from({0.1, 0.5}, {0.9, 0.5})});
    EXPECT_EQ(lines_at(surface, end), 3U);
    EXPECT_EQ(surface.triangulation.lines.size(), 3U);
}

TEST(InsertLines, along_the_border_there_is_nothing_to_insert)
{
    for (const double off : {0.0, 1e-9, 1e-6, -1e-9, -1e-6}) {
        SCOPED_TRACE(off);
        const LinedSurface surface = with_lines(
            unit_square, {line_from({0.2, off}, {0.8, off}), line_from({1 - off, 0}, {1 - off, 1}, LineKind::contact)});
        EXPECT_TRUE(surface.triangulation.lines.empty());
    }
}

TEST(InsertLines, on_the_border_ends_lie_exactly)
{
    for (const double off : {0.0, 1e-9, 1e-6, -1e-6}) {
        SCOPED_TRACE(off);
        const LinedSurface surface = with_lines(unit_square, {line_from({0.3, off}, {0.6, 1 - off})}, tilted_frame());
        ASSERT_EQ(surface.triangulation.lines.size(), 1U);
        EXPECT_EQ(surface.triangulation.triangles.size(), 4U);
        for (const std::uint32_t v : surface.triangulation.lines[0].vertices)
            EXPECT_LE(distance_to_border(surface.scene, surface.scene.surfaces[0], surface.triangulation.positions[v]),
                      1e-15 * 5);
    }
}

TEST(InsertLines, what_leaves_the_polygon_is_cut_off)
{
    const LinedSurface surface = with_lines(unit_square, {line_from({-3, 0.4}, {5, 0.6}), line_from({1.2, 0}, {1.2, 1}),
                                                          line_from({0.5, 0.8}, {0.5, 1.3})});
    EXPECT_NEAR(length_of_lines(surface), std::hypot(1.0, 0.2 / 8) + 0.2, 1e-8);
    for (const auto& edge : surface.triangulation.lines)
        for (const std::uint32_t v : edge.vertices) EXPECT_GE(distance_to_segment(surface.at(v), {0, 0}, {1, 0}), 0.3);
}

TEST(InsertLines, over_a_hole_both_parts_are_there)
{
    const PlaneLoops window{rectangle_loop(0, 0, 1, 1), turned(rectangle_loop(0.3, 0.3, 0.7, 0.6))};
    const LinedSurface across = with_lines(window, {line_from({0.1, 0.5}, {0.9, 0.5})});
    EXPECT_EQ(across.triangulation.lines.size(), 2U);
    EXPECT_NEAR(length_of_lines(across), 0.4, 1e-8);
    const LinedSurface along = with_lines(window, {line_from({0.1, 0.6}, {0.9, 0.6})});
    EXPECT_NEAR(length_of_lines(along), 0.4, 1e-8) << "from corner to corner of the hole it is border";
    const LinedSurface through = with_lines(window, {line_from({0.2, 0.2}, {0.8, 0.8})});
    EXPECT_NEAR(length_of_lines(through), std::numbers::sqrt2 * 0.3, 1e-8) << "through one of its corners";
    EXPECT_TRUE(with_lines(window, {line_from({0.4, 0.4}, {0.6, 0.5})}).triangulation.lines.empty());
}

TEST(InsertLines, fans_of_lines_meet_in_a_point)
{
    for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()}) {
        std::vector<SurfaceLine> lines;
        for (int i = 0; i < 60; ++i) {
            const double angle = (i + 0.3) * std::numbers::pi / 180;
            lines.push_back(line_from({0.2, 0.1}, Vec2(0.2, 0.1) + 0.7 * Vec2(std::cos(angle), std::sin(angle))));
        }
        const LinedSurface surface = with_lines(unit_square, lines, frame);
        EXPECT_EQ(lines_at(surface, {0.2, 0.1}), 60U);
        EXPECT_EQ(surface.triangulation.lines.size(), 60U);
        expect_lines(surface, lines, 2e-9);
    }
}

TEST(InsertLines, fans_that_cross_each_other)
{
    std::vector<SurfaceLine> lines;
    for (int i = 0; i < 25; ++i)
        for (const Vec2& centre : {Vec2(0.5, 0.02), Vec2(0.02, 0.5)}) {
            const double angle = (centre.x > 0.4 ? 75 + i : i - 12) * std::numbers::pi / 180;
            lines.push_back(line_from(centre, centre + 0.9 * Vec2(std::cos(angle), std::sin(angle))));
        }
    expect_lines(with_lines(unit_square, lines, tilted_frame()), lines);
}

TEST(InsertLines, hundreds_of_random_lines_in_polygons_of_all_kinds)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons())
        for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()})
            for (const std::size_t count : {10U, 60U, 250U}) {
                SCOPED_TRACE(name + ", " + std::to_string(count) + ", seed " + std::to_string(seed));
                const std::vector<SurfaceLine> lines = random_lines(loops, count, seed++);
                expect_inside_parts(with_lines(loops, lines, frame), loops, lines, bent_often);
            }
}

// Near the tip of a wedge a point lies on one border and nearer than merging to the other: neither may bend.
TEST(InsertLines, narrow_wedges_of_the_border_stay_what_they_are)
{
    for (const double degrees : {0.001, 0.02, 0.5, 5.0}) {
        SCOPED_TRACE(degrees);
        const PlaneLoops wedge = sharp_triangle(degrees);
        // A notch that narrow: the surface lies on both sides of it.
        const PlaneLoops notch{{{-1, -1}, {2, -1}, {2, 0}, wedge[0][0], wedge[0][2], {1, 1}, {-1, 1}}};
        for (const PlaneFrame& frame : {PlaneFrame{}, tilted_frame()})
            for (const PlaneLoops& loops : {wedge, notch}) {
                std::vector<SurfaceLine> lines;
                for (int i = 0; i < 60; ++i) {
                    const double x = std::pow(10, -5.5 + 0.09 * i), lean = 0.3 * x * (i % 3 - 1);
                    lines.push_back(line_from({x, -0.5}, {x + lean, 0.5}));
                }
                LinedSurface surface(loops, frame);
                const SurfaceTriangulation before = surface.triangulation;
                surface.insert(lines);
                const PatchMesh mesh = surface.mesh();
                double area = 0;
                for (const PatchId p : mesh.patches()) area += mesh.area(p);
                EXPECT_NEAR(area, surface.scene.surfaces[0].area, 1e-10 * area);
                if (degrees < 0.1) continue;  // there the sides are nearer than rounding where lines cross them
                expect_sound_surface(surface, before);
                EXPECT_GE(surface.triangulation.lines.size(), 55U);
                expect_inside_parts(surface, loops, lines, bent);
            }
    }
}

TEST(InsertLines, again_and_again_nothing_is_lost)
{
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(seed);
        LinedSurface surface(unit_square, seed % 2 == 0 ? tilted_frame() : PlaneFrame{});
        std::vector<SurfaceLine> all;
        for (std::uint32_t round = 0; round < 4; ++round) {
            const std::vector<SurfaceLine> lines = random_lines(unit_square, 30, 100 * seed + round);
            all.insert(all.end(), lines.begin(), lines.end());
            const SurfaceTriangulation before = surface.triangulation;
            surface.insert(lines);
            expect_sound_surface(surface, before);
            expect_inside_parts(surface, unit_square, all, bent_often);
        }
    }
}

TEST(InsertLines, what_is_there_already_is_not_inserted_twice)
{
    const std::vector<SurfaceLine> lines{line_from({0.1, 0.2}, {0.9, 0.8}), line_from({0.3, 0.9}, {0.6, 0.1}),
                                         line_from({0.25, 0.1}, {0.25, 0.9})};
    LinedSurface surface = with_lines(unit_square, lines);
    const SurfaceTriangulation before = surface.triangulation;
    for (int round = 0; round < 3; ++round) {
        surface.insert(lines);
        EXPECT_EQ(surface.triangulation.triangles.size(), before.triangles.size());
        EXPECT_EQ(surface.triangulation.lines.size(), before.lines.size());
        expect_sound_surface(surface, before);
    }
}

TEST(InsertLines, halved_edges_leave_lines_what_they_are)
{
    std::uint32_t seed = 1;
    for (const auto& [name, loops] : blunt_polygons()) {
        SCOPED_TRACE(name);
        LinedSurface surface(loops, tilted_frame());
        const std::vector<SurfaceLine> lines = random_lines(loops, 12, seed);
        surface.insert(lines);
        const double length = length_of_lines(surface);
        for (int round = 0; round < 4; ++round) {
            std::mt19937 random(seed++);
            std::vector<std::array<std::uint32_t, 2>> edges;
            for (const auto& t : surface.triangulation.triangles)
                if (const std::size_t k = random() % 9; k < 3) edges.push_back({t[k], t[(k + 1) % 3]});
            const SurfaceTriangulation before = surface.triangulation;
            surface.triangulation = bisect_edges(surface.plane(), before, edges);
            expect_sound_surface(surface, before);
            EXPECT_NEAR(length_of_lines(surface), length, 1e-7 * length);
            expect_inside_parts(surface, loops, lines, bent_often);
        }
    }
}

TEST(InsertLines, scale_does_not_matter)
{
    const std::vector<SurfaceLine> lines = random_lines(unit_square, 80, 5);
    const std::size_t triangles = with_lines(unit_square, lines).triangulation.triangles.size();
    for (const double scale : {std::ldexp(1, -20), std::ldexp(1, 20), 1e-6, 1e6}) {
        SCOPED_TRACE(scale);
        std::vector<SurfaceLine> scaled = lines;
        for (SurfaceLine& line : scaled) {
            line.start *= scale;
            line.end *= scale;
        }
        const PlaneLoops loops{rectangle_loop(0, 0, scale, scale)};
        const LinedSurface surface = with_lines(loops, scaled);
        expect_inside_parts(surface, loops, scaled, bent_often);
        // Where the scale isn't a power of two, rounding may merge otherwise here and there.
        EXPECT_NEAR(static_cast<double>(surface.triangulation.triangles.size()), static_cast<double>(triangles),
                    std::exp2(std::round(std::log2(scale))) == scale ? 0 : 20);
    }
}

TEST(InsertLines, the_same_lines_give_the_same_mesh)
{
    const std::vector<SurfaceLine> lines = random_lines(unit_square, 150, 7);
    const LinedSurface first = with_lines(unit_square, lines), second = with_lines(unit_square, lines);
    EXPECT_EQ(first.triangulation.positions, second.triangulation.positions);
    EXPECT_EQ(first.triangulation.triangles, second.triangulation.triangles);
    expect_same_mesh(first.mesh(), second.mesh());
}
