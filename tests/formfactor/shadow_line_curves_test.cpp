#include "formfactor/point_factor.h"
#include "formfactor/shadow_lines.h"
#include "tests/meshing/written_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace patchlight {
namespace {

using testing::box;
using testing::load;
using testing::rectangle;

using Polygons = std::vector<testing::Polygon>;
using Edge = std::array<Vec3, 2>;

const Vec3 X(1, 0, 0), Y(0, 1, 0);

/// A bar that rises along its length, turned about the z axis through (.5, .5): of edges that are all horizontal the
/// curves on a floor are straight.
Polygons bar(double z, double rise, double angle)
{
    Polygons result = box({.1, .46, z}, {.8, .08, .04}, false);
    for (testing::Polygon& polygon : result)
        for (Vec3& p : polygon.corners) {
            const Vec3 q = p - Vec3(.5, .5, 0) + Vec3(0, 0, rise * (p.x - .5));
            p = Vec3(.5 + std::cos(angle) * q.x - std::sin(angle) * q.y,
                     .5 + std::sin(angle) * q.x + std::cos(angle) * q.y, q.z);
        }
    return result;
}

/// A square light over two skew bars over a floor: its surfaces in this order.
Polygons two_bars()
{
    Polygons result{rectangle({.4, .4, 1}, .2 * Y, .2 * X, "lamp", "lamp")};
    for (const Polygons& some : {bar(.6, .3, .3), bar(.3, -.2, 1.2), Polygons{rectangle({-1, -1, 0}, 3. * X, 3. * Y)}})
        result.insert(result.end(), some.begin(), some.end());
    return result;
}

struct Bars {
    Scene scene = load(two_bars()).scene;
    SurfaceId lamp, floor;
    std::vector<Edge> of_lamp, upper, lower;

    Bars()
    {
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
            const auto& loop = scene.surfaces[s].loops[0];
            const double z = scene.vertices[loop[0]].z + scene.center.z;
            if (scene.material_of(SurfaceId(s)).emits()) lamp = SurfaceId(s);
            if (z < .1) floor = SurfaceId(s);
            auto& edges = z > .9 ? of_lamp : z > .45 ? upper : lower;
            for (std::size_t k = 0; k < loop.size(); ++k)
                edges.push_back({scene.vertices[loop[k]], scene.vertices[loop[(k + 1) % loop.size()]]});
        }
    }
    double floor_z() const { return scene.surface(floor).frame.origin.z; }
    /// Whether a segment runs through the inside of a bar, the part of it in front of none of its faces.
    bool blocked(const Vec3& p, const Vec3& q) const
    {
        std::array<std::array<double, 2>, 2> inside{{{0, 1}, {0, 1}}};
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
            if (SurfaceId(s) == lamp || SurfaceId(s) == floor) continue;
            const PlaneFrame& frame = scene.surfaces[s].frame;
            const double h = glm::dot(frame.n, p - frame.origin), fall = glm::dot(frame.n, q - p);
            auto& [from, to] = inside[frame.origin.z + scene.center.z > .45 ? 0 : 1];
            if (fall < 0) from = std::max(from, -h / fall);
            if (fall > 0) to = std::min(to, -h / fall);
        }
        return std::ranges::any_of(inside, [](const auto& part) { return part[1] - part[0] > 1e-9; });
    }
    std::vector<SurfaceLine> lines(const ShadowLineOptions& options = {}) const
    {
        return shadow_lines(scene, std::array{lamp}, options);
    }
};

/// How far from p, in the direction away from the lines through it past both edges, the third is missed: m; infinite
/// where the line passes one of the two beyond its ends.
double missed_by(const Vec3& p, const Edge& a, const Edge& b, const Edge& s)
{
    constexpr double far = std::numeric_limits<double>::infinity(), slack = 1e-6;
    const Vec3 d = glm::cross(glm::cross(a[0] - p, a[1] - p), glm::cross(b[0] - p, b[1] - p));
    if (glm::length(d) < 1e-12) return far;
    // Of the point of an edge closest to the line.
    const auto place = [&](const Edge& e) {
        const Vec3 across = glm::cross(d, glm::cross(d, e[1] - e[0]));
        return glm::dot(across, p - e[0]) / glm::dot(across, e[1] - e[0]);
    };
    for (const Edge& e : {a, b, s})
        if (!(place(e) >= -slack && place(e) <= 1 + slack)) return far;
    const Vec3 on_s = s[0] + place(s) * (s[1] - s[0]) - p;
    return glm::length(glm::cross(d, on_s)) / glm::length(d);
}

TEST(ShadowLineCurves, PiecesLieOnLinesThatMeetThreeEdges)
{
    const Bars bars;
    const auto residual = [&](const Vec2& q) {
        const Vec3 p = bars.scene.surface(bars.floor).frame.lift(q);
        double least = 1;
        for (const Edge& s : bars.of_lamp)
            for (const Edge& a : bars.upper)
                for (const Edge& b : bars.lower) least = std::min(least, missed_by(p, a, b, s));
        return least;
    };
    std::size_t last = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
        ShadowLineOptions options;
        options.eee_tolerance = tolerance;
        std::size_t found = 0;
        for (const SurfaceLine& l : bars.lines(options)) {
            if (l.kind != LineKind::eee) continue;
            ASSERT_EQ(l.surface, bars.floor);
            ++found;
            // Ends are on the conic but for rounding; merging moves what coincides by the snap. The lower bar is above
            // z = .2: a miss on the floor is one at the lamp at most four times as great.
            EXPECT_LT(residual(l.start), 1e-7);
            EXPECT_LT(residual(l.end), 1e-7);
            EXPECT_LT(residual(0.5 * (l.start + l.end)), 4 * tolerance * bars.scene.diameter);
        }
        EXPECT_GT(found, last);
        last = found;
    }
}

double distance_to(const SurfaceLine& l, const Vec2& q)
{
    const Vec2 along = l.end - l.start;
    return glm::length(q - l.start - std::clamp(glm::dot(q - l.start, along) / glm::dot(along, along), 0., 1.) * along);
}

TEST(ShadowLineCurves, NoneIsMissing)
{
    // Rays from places on the lamp's edges past one edge of each bar, those that pass through neither bar.
    const Bars bars;
    const std::vector<SurfaceLine> lines = bars.lines();
    std::size_t rays = 0, missing = 0;
    for (const Edge& s : bars.of_lamp)
        for (const Edge& a : bars.upper)
            for (const Edge& b : bars.lower)
                for (double t = .0125; t < 1; t += .025) {
                    const Vec3 from = s[0] + t * (s[1] - s[0]);
                    const Vec3 n = glm::cross(a[0] - from, a[1] - from), m = glm::cross(b[0] - from, b[1] - from);
                    Vec3 d = glm::cross(n, m);
                    if (d.z > 0) d = -d;
                    const Vec3 floor = from + (bars.floor_z() - from.z) / d.z * d;
                    if (!(missed_by(floor, a, b, s) < 1e-9) || bars.blocked(from, floor)) continue;
                    ++rays;
                    const Vec2 q = bars.scene.surface(bars.floor).frame.to_plane(floor);
                    missing += std::ranges::none_of(lines, [&](const SurfaceLine& l) {
                        return l.kind == LineKind::eee && distance_to(l, q) <= 1.01e-4 * bars.scene.diameter;
                    });
                }
    EXPECT_GT(rays, 100U);
    EXPECT_EQ(missing, 0U);
}

TEST(ShadowLineCurves, OptionsBoundThem)
{
    const Bars bars;
    const auto curves = [&](const ShadowLineOptions& options) {
        return std::ranges::count(bars.lines(options), LineKind::eee, &SurfaceLine::kind);
    };
    ShadowLineOptions none, few;
    none.eee = false;
    few.most_eee_pairs = 4;
    EXPECT_EQ(curves(none), 0);
    EXPECT_LT(curves(few), curves({}));
}

TEST(ShadowLineCurves, SecondDerivativeJumpsAcrossThem)
{
    const Bars bars;
    const Blockers blockers(bars.scene);
    const std::vector<Facet> lamp = facets_of(bars.scene, bars.lamp);
    const PlaneFrame& frame = bars.scene.surface(bars.floor).frame;
    ShadowLineOptions options;
    options.eee_tolerance = 1e-7;  // much less than a step
    const std::vector<SurfaceLine> lines = bars.lines(options);
    const auto jump = [&](const Vec2& at, const Vec2& step) {
        PointScratch scratch;
        std::array<double, 7> f{};
        for (int k = -3; k <= 3; ++k)
            f[k + 3] = point_factor(blockers, frame.lift(at + double(k) * step), frame.n, lamp, scratch);
        return ((2 * f[3] - 5 * f[4] + 4 * f[5] - f[6]) - (2 * f[3] - 5 * f[2] + 4 * f[1] - f[0])) /
               glm::dot(step, step);
    };
    constexpr double h = 1e-4;
    std::size_t tried = 0, silent = 0;
    for (const SurfaceLine& l : lines) {
        if (l.kind != LineKind::eee) continue;
        const Vec2 at = 0.5 * (l.start + l.end), u = glm::normalize(l.end - l.start), across(-u.y, u.x);
        const Vec2 from = at - 30 * h * across, to = at + 30 * h * across;
        const auto crossed = [&](const SurfaceLine& other) {
            return other.surface == l.surface && cross2(from, to, other.start) * cross2(from, to, other.end) <= 0 &&
                   cross2(other.start, other.end, from) * cross2(other.start, other.end, to) <= 0;
        };
        if (std::ranges::count_if(lines, crossed) != 1) continue;
        ++tried;
        const double J = std::abs(jump(at, h * across)), finer = std::abs(jump(at, 0.5 * h * across));
        const double beside = std::max(std::abs(jump(at + 10 * h * across, h * across)),
                                       std::abs(jump(at - 10 * h * across, h * across)));
        silent += J > 10 * beside && finer > 0.8 * J ? 0 : 1;
    }
    EXPECT_GT(tried, 200U);
    EXPECT_EQ(silent, 0U);
}

}  // namespace
}  // namespace patchlight
