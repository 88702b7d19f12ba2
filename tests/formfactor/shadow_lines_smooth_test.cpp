#include "formfactor/point_factor.h"
#include "formfactor/random_numbers.h"
#include "formfactor/shadow_lines.h"
#include "tests/meshing/written_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace patchlight {
namespace {

using testing::box;
using testing::load;
using testing::rectangle;

using Corners = std::vector<testing::Polygon>;

/// Turned about the z axis through a point, shifted.
void place(Corners& polygons, const Vec3& about, double angle)
{
    for (testing::Polygon& polygon : polygons)
        for (Vec3& p : polygon.corners) {
            const Vec3 q = p - about;
            p = about +
                Vec3(std::cos(angle) * q.x - std::sin(angle) * q.y, std::sin(angle) * q.x + std::cos(angle) * q.y, q.z);
        }
}

/// A convex thing about [0, 1]²: a box that stands or floats, or a plate that lies in the air, stands or is tilted.
Corners random_thing(RandomNumbers& random, bool along_axes)
{
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    const Vec3 low(between(.2, .5), between(.2, .5), random.below(2) == 0 ? 0 : between(.05, .3));
    const Vec3 size(between(.1, .3), between(.1, .3), between(.1, .35));
    Corners thing;
    if (random.below(2) == 0) {
        thing = box(low, size, false);
    } else {
        const double tilt = random.below(2) == 0 ? 0 : between(-1, 1);
        const testing::Polygon plate = random.below(2) == 0
                                           ? rectangle(low, {size.x, 0, 0}, {0, tilt * .1, size.z})
                                           : rectangle(low + Vec3(0, 0, .1), {size.x, 0, tilt * .1}, {0, size.y, 0});
        thing = {plate, plate};
        std::ranges::reverse(thing[1].corners);
    }
    place(thing, low, along_axes ? 0 : between(0, std::numbers::pi));
    return thing;
}

/// A room [−1, 2]² × [0, 1.5], a rectangular light in it that shines down or askew, and things in its way. Half of the
/// rooms are along the axes.
Corners random_room(std::uint64_t seed, int things)
{
    RandomNumbers random(seed, 0x11e5);
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    Corners result = box({-1, -1, 0}, {3, 3, 1.5}, true, "white", "room");
    const bool along_axes = random.below(2) == 0;
    const double lx = between(.1, .4), ly = between(.1, .4);
    const double slope = random.below(3) == 0 ? between(-.6, .6) : 0;
    const Vec3 corner(between(.1, .5), between(.1, .5), between(.8, 1.2));
    Corners light{rectangle(corner, {0, ly, 0}, {lx, 0, slope * lx}, "lamp", "lamp")};
    place(light, corner, along_axes ? 0 : between(0, std::numbers::pi));
    result.insert(result.end(), light.begin(), light.end());
    for (int k = 0; k < things; ++k) {
        Corners thing = random_thing(random, along_axes);
        // Several lie in layers: they don't pierce each other.
        for (testing::Polygon& polygon : thing)
            for (Vec3& p : polygon.corners)
                if (things > 1) p.z = 0.22 * k + 0.28 * p.z;
        result.insert(result.end(), thing.begin(), thing.end());
    }
    return result;
}

/// The exact light of the lamp on a surface.
class SurfaceLight {
public:
    SurfaceLight(const Scene& scene, const Blockers& blockers, SurfaceId lamp, SurfaceId surface)
        : blockers_(blockers), lamp_(facets_of(scene, lamp)), frame_(scene.surface(surface).frame)
    {}
    double operator()(const Vec2& q) const
    {
        PointScratch scratch;
        return point_factor(blockers_, frame_.lift(q), frame_.n, lamp_, scratch);
    }

    Vec3 lift(const Vec2& q) const { return frame_.lift(q); }
    bool cuts_lamp() const
    {
        double least = 0, most = 0;
        for (const Facet& facet : lamp_)
            for (const Vec3& p : facet.corners) {
                const double h = glm::dot(frame_.n, p - frame_.origin);
                least = std::min(least, h);
                most = std::max(most, h);
            }
        return least < -1e-7 && most > 1e-7;
    }

private:
    const Blockers& blockers_;
    std::vector<Facet> lamp_;
    PlaneFrame frame_;
};

/// Jump in the second derivative (or, over h, in the first) at the middle of seven values h apart, from one-sided
/// differences of second order: O(h²) where the function is smooth.
double jump(const double* f, double h)
{
    const double right = 2 * f[0] - 5 * f[1] + 4 * f[2] - f[3], left = 2 * f[0] - 5 * f[-1] + 4 * f[-2] - f[-3];
    return (right - left) / (h * h);
}

constexpr int fine = 8;  ///< parts of a step for a closer look

/// The greatest jump within 3 steps of the k-th as differences of an eighth of a step see it, away from known places
/// (in steps).
double jump_near(const SurfaceLight& light, const Vec2& at, const Vec2& step, const std::vector<double>& known)
{
    constexpr int reach = 3 * fine;
    const Vec2 little = step / double(fine);
    std::vector<double> f;
    for (int k = -reach - 3; k <= reach + 3; ++k) f.push_back(light(at + double(k) * little));
    double most = 0;
    for (int k = -reach; k <= reach; ++k) {
        if (std::ranges::any_of(known, [&](double c) { return std::abs(c * fine - k) <= 3.01; })) continue;
        most = std::max(most, std::abs(jump(&f[k + reach + 3], glm::length(little))));
    }
    return most;
}

std::vector<double> crossings(const std::vector<SurfaceLine>& lines, SurfaceId surface, const Vec2& from,
                              const Vec2& to)
{
    std::vector<double> result;
    for (const SurfaceLine& l : lines) {
        if (l.surface != surface) continue;
        const double a = cross2(from, to, l.start), b = cross2(from, to, l.end);
        if ((a < 0) == (b < 0)) continue;
        const Vec2 at = l.start + a / (a - b) * (l.end - l.start);
        const double t = glm::dot(at - from, to - from) / glm::dot(to - from, to - from);
        if (t > 0 && t < 1) result.push_back(t);
    }
    std::ranges::sort(result);
    return result;
}

/// Where others stand on a surface or pierce it, and its light jumps: edges of the triangulation in its plane.
std::vector<SurfaceLine> contacts(const Scene& scene, SurfaceId on)
{
    std::vector<SurfaceLine> result;
    const PlaneFrame& frame = scene.surface(on).frame;
    const auto height = [&](std::uint32_t v) { return std::abs(glm::dot(frame.n, scene.vertices[v] - frame.origin)); };
    for (const SceneTriangle& t : scene.triangles)
        for (std::size_t k = 0; t.front != on && t.back != on && k < 3; ++k) {
            const std::uint32_t p = t.vertices[k], q = t.vertices[(k + 1) % 3];
            if (height(p) < 1e-7 && height(q) < 1e-7)
                result.push_back(
                    {on, LineKind::contact, frame.to_plane(scene.vertices[p]), frame.to_plane(scene.vertices[q])});
        }
    return result;
}

/// Whether two skew edges of blockers and an edge of the lamp come into line between two points: EEE. Edges in the
/// surface's own plane are no blockers'.
class ThreeEdges {
public:
    ThreeEdges(const Scene& scene, SurfaceId lamp, SurfaceId on)
    {
        const PlaneFrame& frame = scene.surface(on).frame;
        const auto in_plane = [&](const Edge& e) {
            return std::ranges::all_of(
                e, [&](const Vec3& p) { return std::abs(glm::dot(frame.n, p - frame.origin)) < 1e-7; });
        };
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            for (const auto& loop : scene.surfaces[s].loops)
                for (std::size_t k = 0; k < loop.size(); ++k)
                    (s == lamp.value ? lamp_ : others_)
                        .push_back({scene.vertices[loop[k]], scene.vertices[loop[(k + 1) % loop.size()]]});
        std::erase_if(others_, in_plane);
    }
    bool meet_between(const Vec3& from, const Vec3& to) const
    {
        for (const Edge& s : lamp_) {
            std::vector<std::array<double, 2>> places;  // on s, seen from both points past each edge
            for (const Edge& e : others_) {
                const std::array<double, 2> t{place(from, e, s), place(to, e, s)};
                if (t[0] >= 0 && t[1] >= 0) places.push_back(t);
            }
            for (const auto& a : places)
                for (const auto& b : places)
                    if (a[0] < b[0] && a[1] > b[1]) return true;
        }
        return false;
    }

private:
    using Edge = std::array<Vec3, 2>;

    /// Where s is seen past e from q, in [0, 1], or −1.
    static double place(const Vec3& q, const Edge& e, const Edge& s)
    {
        const Vec3 n = glm::cross(e[0] - q, e[1] - q);
        const double h0 = glm::dot(n, s[0] - q), h1 = glm::dot(n, s[1] - q);
        if ((h0 < 0) == (h1 < 0)) return -1;
        const double t = h0 / (h0 - h1);
        const Vec3 ray = s[0] + t * (s[1] - s[0]) - q, m = glm::cross(n, ray);
        return glm::dot(m, e[0] - q) * glm::dot(m, e[1] - q) <= 0 ? t : -1;
    }
    std::vector<Edge> lamp_, others_;
};

/// Found lines along probes, beside breaks of the exact light.
struct Tally {
    std::size_t crossed = 0;      ///< lines
    std::size_t silent = 0;       ///< across which nothing breaks
    std::size_t three_edges = 0;  ///< breaks without a line where three edges meet
    std::size_t horizon = 0;      ///< other breaks without a line on surfaces whose plane cuts the lamp
    std::size_t unexplained = 0;  ///< breaks without any of these
};

constexpr int steps = 2000;  ///< of a probe

/// Walks along a probe. A break is a jump in differences over a step of more than 2 % of the most light there is in
/// the scene's unit; where none is known, one that doesn't vanish as the steps do: a smooth function's go with h².
void walk(const SurfaceLight& light, const Vec2& from, const Vec2& to, const std::vector<double>& lines,
          const std::vector<double>& contacts, const ThreeEdges& three_edges, Tally& tally)
{
    const Vec2 step = (to - from) / double(steps);
    const double h = glm::length(step);
    std::vector<double> f;
    for (int k = 0; k <= steps; ++k) f.push_back(light(from + double(k) * step));
    // Rounding of the light, 1e-16, shows in its differences.
    const double least = std::max(0.02 * *std::ranges::max_element(f), 1e-16 * fine * fine / (h * h));
    std::vector<bool> seen(lines.size());
    int last = -10;
    for (int k = 3; k + 3 <= steps; ++k) {
        const double J = std::abs(jump(&f[k], h));
        if (J <= least) continue;
        bool explained = false;
        for (std::size_t c = 0; c < lines.size(); ++c)
            if (std::abs(lines[c] * steps - k) <= 3.01) explained = seen[c] = true;
        std::vector<double> known;
        for (const auto& list : {lines, contacts})
            for (const double c : list) known.push_back(c * steps - k);
        explained = explained || std::ranges::any_of(known, [](double c) { return std::abs(c) <= 3.01; });
        if (explained || k <= last + 6) continue;
        if (jump_near(light, from + double(k) * step, step, known) < J / 4) continue;
        last = k;
        const auto place = [&](double at) { return light.lift(from + at * step); };
        if (three_edges.meet_between(place(k - 3.6), place(k + 3.6))) {
            ++tally.three_edges;
            continue;
        }
        ++(light.cuts_lamp() ? tally.horizon : tally.unexplained);
    }
    for (std::size_t c = 0; c < lines.size(); ++c) {
        if (lines[c] * steps < 3 || lines[c] * steps > steps - 4) continue;
        ++tally.crossed;
        tally.silent += seen[c] ? 0 : 1;
    }
}

Tally walk_room(std::uint64_t seed, int things)
{
    const Scene scene = load(random_room(seed, things)).scene;
    const Blockers blockers(scene);
    SurfaceId lamp;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).emits()) lamp = SurfaceId(s);
    // Pieces within a tenth of a step of the curves, on the smallest things, too.
    ShadowLineOptions options;
    options.eee_tolerance = 1e-6;
    const std::vector<SurfaceLine> lines = shadow_lines(scene, std::array{lamp}, options);
    RandomNumbers random(seed, 0x9c0be);
    Tally tally;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceId id(s);
        if (!scene.material_of(id).reflects()) continue;
        const SurfaceLight light(scene, blockers, lamp, id);
        const ThreeEdges three_edges(scene, lamp, id);
        const std::vector<SurfaceLine> contact = contacts(scene, id);
        const auto& loop = scene.surface(id).loops[0];
        for (int probe = 0; probe < 2; ++probe) {
            // Across the surface, from one side to another.
            const auto point = [&](std::size_t side) {
                const double t = random.uniform();
                return scene.surface(id).frame.to_plane((1 - t) * scene.vertices[loop[side % loop.size()]] +
                                                        t * scene.vertices[loop[(side + 1) % loop.size()]]);
            };
            const std::size_t side = random.below(4);
            const Vec2 from = point(side), to = point(side + 1 + random.below(3));
            walk(light, from, to, crossings(lines, id, from, to), crossings(contact, id, from, to), three_edges, tally);
        }
    }
    return tally;
}

Tally walk_rooms(std::uint64_t rooms, int things)
{
    Tally sum;
    for (std::uint64_t seed = 0; seed < rooms; ++seed) {
        const Tally tally = walk_room(seed, things);
        sum.crossed += tally.crossed;
        sum.silent += tally.silent;
        sum.three_edges += tally.three_edges;
        sum.horizon += tally.horizon;
        sum.unexplained += tally.unexplained;
    }
    return sum;
}

// One convex thing: no events but those of the lamp's corners and edges, and of planes.
TEST(ShadowLines, BetweenThemTheLightIsSmooth)
{
    const Tally tally = walk_rooms(200, 1);
    EXPECT_GT(tally.crossed, 1000U);
    EXPECT_EQ(tally.unexplained, 0U);
    EXPECT_EQ(tally.three_edges + tally.horizon, 0U);
    // Edge on a line's end, or where the light is too weak to show its break.
    EXPECT_LE(tally.silent, tally.crossed / 500);
}

// With several there are EEE curves, too: without them 36 breaks stay at three edges. On surfaces whose plane cuts the
// lamp the events of the point in which it cuts the lamp's rim, where the light arrives at grazing incidence, are
// missing.
TEST(ShadowLines, BehindSeveralThingsNearlyAllAreThere)
{
    const Tally tally = walk_rooms(100, 3);
    EXPECT_GT(tally.crossed, 1500U);
    EXPECT_LE(tally.unexplained, tally.crossed / 1000);
    EXPECT_LE(tally.three_edges, tally.crossed / 500);
    EXPECT_LE(tally.horizon, tally.crossed / 25);
    EXPECT_LE(tally.silent, tally.crossed / 500);
}

}  // namespace
}  // namespace patchlight
