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

/// A floor [0, 1]², a rectangular light above it, facing down or tilted, and one convex thing: a box that stands or
/// floats, or a plate that lies in the air, stands on the floor or is tilted. Half of them along the axes.
Corners random_room(std::uint64_t seed)
{
    RandomNumbers random(seed, 0x11e5);
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    Corners result{rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})};
    const bool along_axes = random.below(2) == 0;
    const auto turn = [&] { return along_axes ? 0 : between(0, std::numbers::pi); };

    const double lx = between(.1, .4), ly = between(.1, .4);
    const double slope = random.below(3) == 0 ? between(-.6, .6) : 0;
    const Vec3 corner(between(.1, .5), between(.1, .5), between(.8, 1.2));
    Corners light{rectangle(corner, {0, ly, 0}, {lx, 0, slope * lx}, "lamp", "lamp")};
    place(light, corner, turn());
    result.insert(result.end(), light.begin(), light.end());

    const Vec3 low(between(.2, .5), between(.2, .5), random.below(2) == 0 ? 0 : between(.05, .3));
    const Vec3 size(between(.1, .3), between(.1, .3), between(.1, .35));
    Corners thing;
    if (random.below(2) == 0) {
        thing = box(low, size, false);
    } else {
        const double tilt = random.below(2) == 0 ? 0 : between(-1, 1);
        const testing::Polygon plate = random.below(2) == 0
                                           ? rectangle(low, {size.x, 0, 0}, {tilt * .1, 0, size.z})
                                           : rectangle(low + Vec3(0, 0, .1), {size.x, 0, tilt * .1}, {0, size.y, 0});
        thing = {plate, plate};
        std::ranges::reverse(thing[1].corners);
    }
    place(thing, low, turn());
    result.insert(result.end(), thing.begin(), thing.end());
    return result;
}

/// The exact light on the floor.
class FloorLight {
public:
    explicit FloorLight(const Scene& scene) : blockers_(scene)
    {
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
            const SurfaceId id(s);
            if (scene.material_of(id).emits()) light_ = id;
            // The lowest there is.
            if (!floor_.valid() ||
                (scene.surface(id).frame.n.z > 0.99 && scene.surface(id).area > scene.surface(floor_).area))
                floor_ = id;
        }
        facets_ = facets_of(scene, light_);
        frame_ = scene.surface(floor_).frame;
    }
    double operator()(const Vec2& q) const
    {
        PointScratch scratch;
        return point_factor(blockers_, frame_.lift(q), frame_.n, facets_, scratch);
    }
    SurfaceId light() const { return light_; }
    SurfaceId floor() const { return floor_; }
    const PlaneFrame& frame() const { return frame_; }

private:
    Blockers blockers_;
    std::vector<Facet> facets_;
    SurfaceId light_, floor_;
    PlaneFrame frame_;
};

/// Jump in the second derivative (or, over h, in the first) at the middle of seven values h apart, from one-sided
/// differences of second order: O(h²) where the function is smooth.
double jump(const double* f, double h)
{
    const double right = 2 * f[0] - 5 * f[1] + 4 * f[2] - f[3], left = 2 * f[0] - 5 * f[-1] + 4 * f[-2] - f[-3];
    return (right - left) / (h * h);
}

/// The greatest jump within 3 steps of the k-th as differences of an eighth of a step see it, away from known places
/// (in steps).
double jump_near(const FloorLight& light, const Vec2& at, const Vec2& step, const std::vector<double>& known)
{
    constexpr int fine = 8, reach = 3 * fine;
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

/// Where something stands on the floor.
std::vector<SurfaceLine> contacts(const Scene& scene, SurfaceId floor)
{
    std::vector<SurfaceLine> result;
    const PlaneFrame& frame = scene.surface(floor).frame;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        for (const auto& loop : scene.surfaces[s].loops)
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec3 &p = scene.vertices[loop[k]], &q = scene.vertices[loop[(k + 1) % loop.size()]];
                const auto height = [&](const Vec3& x) { return std::abs(glm::dot(frame.n, x - frame.origin)); };
                if (s != floor.value && height(p) < 1e-9 && height(q) < 1e-9)
                    result.push_back({floor, LineKind::contact, frame.to_plane(p), frame.to_plane(q)});
            }
    return result;
}

TEST(ShadowLines, BetweenThemTheLightIsSmooth)
{
    constexpr int steps = 4000;
    std::size_t kinks = 0, unexplained = 0, crossed = 0, silent = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const Scene scene = load(random_room(seed)).scene;
        const FloorLight light(scene);
        const std::vector<SurfaceLine> lines = shadow_lines(scene, std::array{light.light()});
        RandomNumbers random(seed, 0x9c0be);
        for (int probe = 0; probe < 4; ++probe) {
            const auto point = [&] {
                return light.frame().to_plane(Vec3(random.uniform(), random.uniform(), 0) - scene.center);
            };
            const Vec2 from = point(), to = point();
            const double h = glm::length(to - from) / steps;
            std::vector<double> f(steps + 1);
            for (int k = 0; k <= steps; ++k) f[k] = light(from + (to - from) * (k / double(steps)));
            const double most = *std::ranges::max_element(f);
            if (most == 0) continue;
            const std::vector<double> known = crossings(lines, light.floor(), from, to);
            const std::vector<double> contact = crossings(contacts(scene, light.floor()), light.floor(), from, to);
            std::vector<bool> seen(known.size());
            int last = -10;
            for (int k = 3; k + 3 <= steps; ++k) {
                const double J = std::abs(jump(&f[k], h));
                if (J < 0.02 * most) continue;
                bool explained = false;
                for (std::size_t c = 0; c < known.size(); ++c)
                    if (std::abs(known[c] * steps - k) <= 3.01) explained = seen[c] = true;
                for (const double c : contact) explained = explained || std::abs(c * steps - k) <= 3.01;
                if (explained || k <= last + 6) continue;
                std::vector<double> places;
                for (const auto& list : {known, contact})
                    for (const double c : list) places.push_back(c * steps - k);
                const Vec2 step = (to - from) / double(steps);
                const double closer = jump_near(light, from + double(k) * step, step, places);
                if (closer < J / 4) continue;
                ++unexplained;
                if (k > last + 6) {
                    double near = 1e9;
                    for (double c : known) near = std::min(near, std::abs(c * steps - k));
                    const Vec2 q = from + (to - from) * (k / double(steps));
                    const Vec3 p = light.frame().lift(q) + scene.center;
                    std::printf(
                        "seed %d probe %d k %d J %.3g closer %.3g most %.3g h %.3g nearest %.1f at %.4f %.4f %.4f\n",
                        int(seed), probe, k, J, closer, most, h, near, p.x, p.y, p.z);
                }
                last = k;
            }
            crossed += known.size();
            kinks += std::ranges::count(seen, true);
            for (std::size_t c = 0; c < known.size(); ++c) {
                const double at = known[c] * steps;
                if (seen[c] || at < 3 || at > steps - 4) continue;
                ++silent;
                const int k = int(std::lround(at));
                std::printf("  silent: seed %d probe %d at %.1f J %.3g f %.3g\n", int(seed), probe, at, jump(&f[k], h),
                            f[k]);
            }
        }
    }
    std::printf("crossed %zu kinks %zu silent %zu unexplained %zu\n", crossed, kinks, silent, unexplained);
    EXPECT_EQ(unexplained, 0U);
    EXPECT_GT(kinks, crossed * 9 / 10);
}

}  // namespace
}  // namespace patchlight
