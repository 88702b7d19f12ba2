#include "formfactor/shadow_lines.h"
#include "tests/meshing/written_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

namespace patchlight {
namespace {

using testing::box;
using testing::load;
using testing::rectangle;
using testing::rotated;

using Polygons = std::vector<testing::Polygon>;

/// A line in space, in the coordinates of the file, ends in order.
struct Found {
    LineKind kind;
    Vec3 start, end;
};

std::vector<SurfaceId> emitters(const Scene& scene)
{
    std::vector<SurfaceId> result;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).emits()) result.push_back(SurfaceId(s));
    return result;
}

std::vector<Found> lines_of(const Scene& scene)
{
    std::vector<Found> result;
    for (const SurfaceLine& l : shadow_lines(scene, emitters(scene))) {
        const PlaneFrame& frame = scene.surface(l.surface).frame;
        Vec3 p = frame.lift(l.start) + scene.center, q = frame.lift(l.end) + scene.center;
        if (std::tie(q.x, q.y, q.z) < std::tie(p.x, p.y, p.z)) std::swap(p, q);
        result.push_back({l.kind, p, q});
    }
    return result;
}

std::vector<Found> lines_of(const Polygons& polygons)
{
    return lines_of(load(polygons).scene);
}

// Lines are as exact as the intersection of two planes, but for what snapping may move: 1e-8 of some metres, seen
// under a flat angle.
constexpr double near = 1e-7;

std::size_t count(const std::vector<Found>& lines, const Vec3& start, const Vec3& end)
{
    return std::ranges::count_if(lines, [&](const Found& l) {
        return (glm::distance(l.start, start) < near && glm::distance(l.end, end) < near) ||
               (glm::distance(l.start, end) < near && glm::distance(l.end, start) < near);
    });
}

void expect(const std::vector<Found>& lines, LineKind kind, const Vec3& start, const Vec3& end)
{
    const auto matches = [&](const Found& l) {
        return l.kind == kind && ((glm::distance(l.start, start) < near && glm::distance(l.end, end) < near) ||
                                  (glm::distance(l.start, end) < near && glm::distance(l.end, start) < near));
    };
    EXPECT_EQ(std::ranges::count_if(lines, matches), 1)
        << name_of(kind) << " (" << start.x << " " << start.y << " " << start.z << ") to (" << end.x << " " << end.y
        << " " << end.z << ")";
}

/// The shadow on z = 0 of a point at height z, from a light at height 1, of one coordinate.
double shadow(double light, double blocker, double z)
{
    return light + (blocker - light) / (1 - z);
}

const Vec3 X(1, 0, 0), Y(0, 1, 0), Z(0, 0, 1);

testing::Polygon floor_square()
{
    return rectangle({0, 0, 0}, X, Y);
}

/// A light at z = 1 over [x0, x1] × [y0, y1] that shines down.
testing::Polygon lamp(double x0, double x1, double y0, double y1)
{
    return rectangle({x0, y0, 1}, (y1 - y0) * Y, (x1 - x0) * X, "lamp", "lamp");
}

/// Both sides.
Polygons plate(const Vec3& a, const Vec3& u, const Vec3& v)
{
    return {rectangle(a, u, v), rectangle(a, v, u)};
}

Polygons operator+(Polygons a, const Polygons& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST(ShadowLines, NarrowPenumbra)
{
    // Light and blocker have parallel sides: of the 16 EV and 16 VE pieces those of one line are one.
    const auto lines = lines_of(read_scene(PATCHLIGHT_DATA "/scenes/narrow-penumbra.obj").scene);
    const double low_x = shadow(.55, .31, .15), high_x = shadow(.45, .67, .15);
    const double low_y = shadow(.55, .36, .15), high_y = shadow(.45, .71, .15);
    EXPECT_EQ(lines.size(), 8U);
    for (const double light : {.45, .55}) {
        for (const double b : {.31, .67})
            expect(lines, LineKind::ev, {shadow(light, b, .15), low_y, 0}, {shadow(light, b, .15), high_y, 0});
        for (const double b : {.36, .71})
            expect(lines, LineKind::ev, {low_x, shadow(light, b, .15), 0}, {high_x, shadow(light, b, .15), 0});
    }
}

TEST(ShadowLines, WidePenumbraIsCutAtTheReceiversBorder)
{
    const auto lines = lines_of(read_scene(PATCHLIGHT_DATA "/scenes/wide-penumbra.obj").scene);
    EXPECT_EQ(lines.size(), 6U);  // the others fall beyond x = 1, y = 1
    for (const double at : {.1, .5, .7}) {
        expect(lines, LineKind::ev, {at, .1, 0}, {at, 1, 0});
        expect(lines, LineKind::ev, {.1, at, 0}, {1, at, 0});
    }
}

TEST(ShadowLines, WallOnFloor)
{
    const auto lines = lines_of(read_scene(PATCHLIGHT_DATA "/scenes/wall-on-floor.obj").scene);
    const double near_x = shadow(.4, .52, .3), far_x = shadow(.1, .52, .3);
    const double low_y = shadow(.6, .25, .3), high_y = shadow(.3, .75, .3);
    EXPECT_EQ(lines.size(), 14U);
    for (const double x : {near_x, far_x}) expect(lines, LineKind::ev, {x, low_y, 0}, {x, high_y, 0});
    for (const double b : {.25, .75})
        for (const double y : {.3, .6}) {
            expect(lines, LineKind::ve, {near_x, shadow(y, b, .3), 0}, {far_x, shadow(y, b, .3), 0});
            // The upright edges' shadows start at their feet.
            for (const double x : {near_x, far_x}) expect(lines, LineKind::ev, {.52, b, 0}, {x, shadow(y, b, .3), 0});
        }
}

TEST(ShadowLines, ASecondBlockerHidesExactlyAPart)
{
    const Polygons scene =
        Polygons{floor_square(), lamp(.45, .55, .45, .55)} + plate({.31, .36, .15}, .36 * X, .35 * Y);
    const double x = shadow(.45, .31, .15), until = shadow(.45, .71, .15);
    expect(lines_of(scene), LineKind::ev, {x, shadow(.55, .36, .15), 0}, {x, until, 0});
    // Over y < .5 at half height: from (.45, .55, 1) it hides the floor below y = .45, from (.45, .45, 1) below .55.
    expect(lines_of(scene + plate({-.2, -.2, .5}, 1.5 * X, .7 * Y)), LineKind::ev, {x, .45, 0}, {x, until, 0});
    // Under the first blocker, on the left half of its shadow: the line ends on it, at its height, and goes on beside
    // it.
    const auto below = lines_of(scene + plate({.2, .5, .05}, .2 * X, .1 * Y));
    const auto at_height = [](double light, double b) { return light + (b - light) * .95 / .85; };
    expect(below, LineKind::ev, {at_height(.45, .31), .5, .05}, {at_height(.45, .31), .6, .05});
    EXPECT_EQ(count(below, {x, shadow(.55, .36, .15), 0}, {x, until, 0}), 0U);
}

TEST(ShadowLines, NoneBehindAWall)
{
    // Two rooms; the light's has a box, the other another one.
    const Polygons rooms = box({0, 0, 0}, {2, 1, 1}, true) + plate({1, 0, 0}, Y, Z) +
                           Polygons{rectangle({.3, .3, .9}, .2 * Y, .2 * X, "lamp", "lamp")} +
                           box({.5, .5, 0}, {.1, .1, .3}, false) + box({1.5, .5, 0}, {.1, .1, .3}, false);
    const auto lines = lines_of(rooms);
    EXPECT_GT(lines.size(), 10U);
    for (const Found& l : lines) EXPECT_LE(std::max(l.start.x, l.end.x), 1 + near);
}

TEST(ShadowLines, NoneInAConvexRoomWithTheLightInItsCeiling)
{
    EXPECT_EQ(lines_of(testing::room_with_lamp()).size(), 0U);
}

TEST(ShadowLines, NoneFromALightsOwnRecess)
{
    // Edges between surfaces that both face the light are no outlines; the recess' rim is one.
    Polygons room = testing::room_with_lamp();
    for (Vec3& p : room.back().corners) p.z += .2;
    const Polygons sides = box({1, 1, 3}, {1, 1, .2}, true);
    room.insert(room.end(), sides.begin() + 2, sides.end());
    const auto lines = lines_of(room);
    EXPECT_GT(lines.size(), 0U);
    for (const Found& l : lines) EXPECT_LT(std::max(l.start.z, l.end.z), 3 - near) << "beyond the rim only";
}

TEST(ShadowLines, PlateInTheLightsPlaneThrowsNoShadow)
{
    EXPECT_EQ(lines_of(Polygons{floor_square(), lamp(.4, .6, .4, .6)} + plate({.7, .4, 1}, .2 * X, .2 * Y)).size(), 0U);
}

TEST(ShadowLines, PlateOnTheFloorThrowsNoShadow)
{
    const auto lines = lines_of(Polygons{floor_square(), lamp(.4, .6, .4, .6)} + plate({.3, .4, 0}, .2 * X, .2 * Y));
    EXPECT_EQ(lines.size(), 0U);
}

TEST(ShadowLines, PlateBehindTheLightThrowsNoShadow)
{
    EXPECT_EQ(lines_of(Polygons{floor_square(), lamp(.4, .6, .4, .6)} + plate({.3, .4, 1.1}, .5 * X, .2 * Y)).size(),
              0U);
}

TEST(ShadowLines, PlateHangingFromTheLightsEdge)
{
    // The plate's plane x = .4 goes through the light's edge: its line is where the light begins to be cut, as far as
    // the ends of the light are seen through the plate, which begins at the light itself: everywhere.
    const auto lines = lines_of(Polygons{floor_square(), lamp(.4, .6, .4, .6)} + plate({.4, .4, .5}, .2 * Y, .5 * Z));
    expect(lines, LineKind::plane, {.4, 0, 0}, {.4, 1, 0});
    // From x = .6 it is thrown to x = .2.
    expect(lines, LineKind::ev, {.2, .2, 0}, {.2, .8, 0});
}

TEST(ShadowLines, PlateSeenEdgeOn)
{
    // From the light's middle line x = .5, y in [.4, .6], the plate y in [.45, .55], z in [.2, .5] covers .3 … .7
    // together.
    const auto lines = lines_of(Polygons{floor_square(), lamp(.4, .6, .4, .6)} + plate({.5, .45, .2}, .1 * Y, .3 * Z));
    expect(lines, LineKind::plane, {.5, shadow(.6, .45, .5), 0}, {.5, shadow(.4, .55, .5), 0});
}

TEST(ShadowLines, TheLightsPlaneOnAWall)
{
    // The wall rises above the light: lit below z = 1 only. The wall's other side is turned away.
    const Polygons open{floor_square(), lamp(.4, .6, .4, .6), rectangle({0, 0, 0}, Y, 2.0 * Z)};
    expect(lines_of(open), LineKind::plane, {0, 0, 1}, {0, 1, 1});
    // A plate across that plane, to y = .5: the part that neither corner of the light sees has no line.
    const auto lines = lines_of(open + plate({.2, .5, .9}, -.5 * Y, .2 * Z));
    EXPECT_EQ(count(lines, {0, 0, 1}, {0, 1, 1}), 0U);
    expect(lines, LineKind::plane, {0, shadow(.6, .5, .5), 1}, {0, 1, 1});
}

TEST(ShadowLines, HiddenEdgesOfAStandingBox)
{
    // Neither the foot nor the edges turned to the light or away from it throw shadows: from a light that sees three
    // sides, the outline on the floor has four edges, two of them upright, beside those of the two hidden corners.
    const Polygons scene = Polygons{floor_square(), lamp(.05, .15, .05, .15)} + box({.4, .4, 0}, {.2, .2, .2}, false);
    for (const Found& l : lines_of(scene)) {
        if (std::max(l.start.z, l.end.z) > near) continue;
        for (const Vec3& p : {l.start, l.end})
            EXPECT_FALSE(p.x < .6 - near && p.y < .6 - near && p.x + p.y > .8 + near);
        const bool at_near_foot =
            glm::distance(l.start, {.4, .4, 0}) < near || glm::distance(l.end, {.4, .4, 0}) < near;
        EXPECT_FALSE(at_near_foot);
    }
    expect(lines_of(scene), LineKind::ev, {.4, .6, 0}, {shadow(.05, .4, .2), shadow(.05, .6, .2), 0});
    expect(lines_of(scene), LineKind::ev, {.6, .4, 0}, {shadow(.05, .6, .2), shadow(.05, .4, .2), 0});
}

TEST(ShadowLines, ABoxWithoutABottomIsTheSame)
{
    const Polygons lit{floor_square(), lamp(.1, .3, .1, .3)};
    Polygons open = box({.4, .4, 0}, {.2, .2, .2}, false);
    const auto closed_lines = lines_of(lit + open);
    open.erase(open.begin());
    const auto open_lines = lines_of(lit + open);
    EXPECT_EQ(open_lines.size(), closed_lines.size());
    for (const Found& l : open_lines) expect(closed_lines, l.kind, l.start, l.end);
}

Polygons small_room()
{
    return box({0, 0, 0}, {2, 2, 1}, true) + Polygons{rectangle({.6, .7, .9}, .3 * Y, .4 * X, "lamp", "lamp")} +
           box({.5, 1, 0}, {.4, .3, .3}, false) + box({1.2, .4, .2}, {.3, .2, .4}, false) +
           plate({1, 1.2, .4}, .3 * X + .1 * Z, .4 * Y);
}

TEST(ShadowLines, SizePlaceAndOrderDoNotMatter)
{
    const Polygons polygons = small_room();
    const auto expected = lines_of(polygons);
    EXPECT_GT(expected.size(), 50U);
    const auto same = [&](const Polygons& changed, double scale, const Vec3& shift) {
        const auto lines = lines_of(load(changed, {}, [&](const Vec3& p) { return scale * p + shift; }).scene);
        EXPECT_EQ(lines.size(), expected.size());
        for (const Found& l : lines) expect(expected, l.kind, (l.start - shift) / scale, (l.end - shift) / scale);
    };
    same(polygons, 1e-6, {});
    same(polygons, 1e6, {});
    same(polygons, 1, {-1000, 300, 70});
    Polygons reversed = polygons;
    std::ranges::reverse(reversed);
    same(reversed, 1, {});
    for (testing::Polygon& p : reversed) std::ranges::rotate(p.corners, p.corners.begin() + 1);
    same(reversed, 1, {});
}

TEST(ShadowLines, TurnedScenesHaveTheSameLines)
{
    // Axis-aligned planes through many edges at once become planes through them within rounding.
    const auto expected = lines_of(small_room());
    const auto turned = lines_of(load(small_room(), {}, rotated).scene);
    EXPECT_EQ(turned.size(), expected.size());
    std::size_t found = 0;
    for (const Found& l : expected) found += count(turned, rotated(l.start), rotated(l.end));
    EXPECT_EQ(found, expected.size());
}

TEST(ShadowLines, NothingButFiniteLinesOfLength)
{
    const Scene scene = load(small_room()).scene;
    for (const SurfaceLine& l : shadow_lines(scene, emitters(scene)))
        EXPECT_GT(glm::length(l.end - l.start), 1e-8 * scene.diameter);  // false for NaN
}

}  // namespace
}  // namespace patchlight
