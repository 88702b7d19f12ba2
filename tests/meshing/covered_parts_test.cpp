#include "contact_scenes.h"

#include <array>
#include <optional>

using namespace patchlight;
using namespace patchlight::testing;

namespace {

/// What snapping may shift, in scenes some 10 m across, as a slanting ray sees it.
constexpr double near = 1e-6;

struct Ray {
    Vec3 origin, direction;
};

/// The distance at which a ray meets a convex polygon.
std::optional<double> met(const Ray& ray, const Polygon& polygon)
{
    const Vec3 n = normal_of(polygon);
    const double t = glm::dot(polygon.corners[0] - ray.origin, n) / glm::dot(ray.direction, n);
    if (!(t > near)) return {};
    const Vec3 x = ray.origin + t * ray.direction;
    for (std::size_t k = 0; k < polygon.corners.size(); ++k) {
        const Vec3 &a = polygon.corners[k], &b = polygon.corners[(k + 1) % polygon.corners.size()];
        if (glm::dot(glm::cross(b - a, x - a), n) < 0) return {};
    }
    return t;
}

/// Whether the first thing a ray meets is nothing but a back; false if it meets nothing.
bool meets_a_back(const Ray& ray, const std::vector<Polygon>& polygons)
{
    double nearest = 1e300;
    bool front = false;
    for (const Polygon& p : polygons) {
        const auto t = met(ray, p);
        if (!t || *t > nearest + near) continue;
        const bool faces = glm::dot(normal_of(p), ray.direction) < 0;
        front = *t < nearest - near ? faces : front || faces;
        nearest = std::min(nearest, *t);
    }
    return nearest < 1e300 && !front;
}

/// Whether some surface that faces the way of n lies at p, file coordinates.
bool has_surface(const Scene& scene, const Vec3& p, const Vec3& n)
{
    for (const SceneTriangle& t : scene.triangles) {
        for (const SurfaceId side : {t.front, t.back}) {
            if (!side.valid() || glm::dot(scene.surface(side).frame.n, n) < 0.99) continue;
            Polygon triangle;
            for (const std::uint32_t v : t.vertices) triangle.corners.push_back(scene.vertices[v] + scene.center);
            const auto height = met({p - n, n}, triangle);
            if (height && std::abs(*height - 1) < near) return true;
        }
    }
    return false;
}

/// Blocks that stand on a floor, are sunk into it, or hover, partly in one another; with `grid`, on a coarse grid, so
/// that many touch; some turned by as much as nothing, or by less than snapping.
std::vector<Polygon> random_blocks(std::mt19937& random, bool grid)
{
    std::uniform_real_distribution<double> unit(0, 1);
    const auto draw = [&](double from, double to) {
        const double x = from + (to - from) * unit(random);
        return grid ? std::round(2 * x) / 2 : x;
    };
    std::vector<Polygon> polygons = lit_floor({});
    for (int b = 0; b < 5; ++b) {
        const double z = std::array{0.0, 0.0, -0.25, 0.5}[random() % 4];
        const double angle = std::array{0.0, 0.0, 1e-9, 0.3}[random() % 4];
        const Vec3 low{draw(0.5, 2.5), draw(0.5, 2.5), z}, size{draw(0.5, 1.4), draw(0.5, 1.4), draw(0.5, 1.4)};
        for (Polygon& side : red_box(low, size, random() % 2 == 0)) {
            for (Vec3& p : side.corners) {
                p = {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle), p.z};
            }
            polygons.push_back(side);
        }
    }
    return polygons;
}

Vec3 random_point(const Polygon& p, std::mt19937& random)
{
    std::uniform_real_distribution<double> unit(0, 1);
    const Vec3& o = p.corners[0];
    const double u = unit(random), v = unit(random);
    return o + u * (p.corners[1] - o) + v * (p.corners[3] - o);
}

/// Steep enough to keep clear of what snapping moved.
Vec3 random_direction(const Vec3& n, std::mt19937& random)
{
    std::uniform_real_distribution<double> one(-1, 1);
    for (;;) {
        const double x = one(random), y = one(random), z = one(random);
        const Vec3 d{x, y, z};
        if (std::abs(glm::dot(d, n)) > 0.1 * glm::length(d)) return glm::normalize(glm::dot(d, n) > 0 ? d : -d);
    }
}

}  // namespace

TEST(CoveredParts, blocks_in_a_heap_share_what_they_meet_in)
{
    std::mt19937 random(5);
    for (int round = 0; round < 60; ++round) {
        const auto polygons = random_blocks(random, round % 2 == 0);
        const LoadedScene loaded = load(polygons, {}, round % 3 == 0 ? Placement(rotated) : Placement());
        expect_sound(loaded);
        expect_nothing_pierced(loaded);
    }
}

TEST(CoveredParts, only_that_goes_whose_rays_all_meet_backs)
{
    std::mt19937 random(6);
    std::size_t covered = 0;
    for (int round = 0; round < 40; ++round) {
        const auto polygons = random_blocks(random, round % 2 == 0);
        const Scene scene = load(polygons).scene;
        for (int k = 0; k < 800; ++k) {
            const Polygon& polygon = polygons[random() % polygons.size()];
            const Vec3 p = random_point(polygon, random), n = normal_of(polygon);
            if (has_surface(scene, p, n)) continue;
            ++covered;
            for (int r = 0; r < 20; ++r)
                EXPECT_TRUE(meets_a_back({p, random_direction(n, random)}, polygons)) << "round " << round;
        }
    }
    EXPECT_GT(covered, 100U);
}
