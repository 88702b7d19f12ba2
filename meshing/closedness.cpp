#include "meshing/closedness.h"

#include "meshing/union_find.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace patchlight {

namespace {

/// In no way special, so that rays along it meet no edges of axis-aligned scenes.
const Vec3 outward = glm::normalize(Vec3{0.61330, 0.54171, 0.57489});
constexpr double most_tests = 5e8;

/// Side 2t of triangle t is the one its counter-clockwise normal points from, 2t + 1 the other.
constexpr std::uint32_t side_of(std::uint32_t triangle, bool front)
{
    return 2 * triangle + (front ? 0 : 1);
}

struct EdgeUse {
    std::uint32_t low, high;
    double angle;  ///< of the triangle, round the edge
    std::uint32_t triangle;
    bool ascending;  ///< the triangle runs from low to high
};

std::vector<EdgeUse> edge_uses(const Scene& scene)
{
    std::vector<EdgeUse> uses;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto& v = scene.triangles[t].vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k], b = v[(k + 1) % 3];
            const std::uint32_t low = std::min(a, b), high = std::max(a, b);
            const Vec3 axis = glm::normalize(scene.vertices[high] - scene.vertices[low]);
            const Vec3 arm = scene.vertices[v[(k + 2) % 3]] - scene.vertices[low];
            const Vec3 start = glm::cross(axis, std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
            const double angle = std::atan2(glm::dot(arm, glm::cross(axis, start)), glm::dot(arm, start));
            uses.push_back({low, high, angle, t, a == low});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high, a.angle, a.triangle) < std::tie(b.low, b.high, b.angle, b.triangle);
    });
    return uses;
}

/// Joins the sides that face each other round every edge.
UnionFind join_sides(const Scene& scene)
{
    UnionFind sides(2 * scene.triangles.size());
    const std::vector<EdgeUse> uses = edge_uses(scene);
    for (std::size_t first = 0; first < uses.size();) {
        std::size_t last = first;
        while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) ++last;
        for (std::size_t i = first; i < last; ++i) {
            const EdgeUse& here = uses[i];
            const EdgeUse& next = uses[i + 1 < last ? i + 1 : first];
            // The normal of a triangle that runs along the edge points the way the angle grows.
            sides.join(side_of(here.triangle, here.ascending), side_of(next.triangle, !next.ascending));
        }
        first = last;
    }
    return sides;
}

struct Shell {
    double volume = 0;     ///< that its sides face, six times; negative when they face outward
    double magnitude = 0;  ///< of the terms that volume sums
    Vec3 base{0.0};
    Vec3 outermost{0.0};
};

/// The scene's sides, joined into shells, and the regions these lie in.
class Regions {
public:
    explicit Regions(const Scene& scene);
    bool all_light_enclosed();

private:
    bool encloses(const Shell& shell) const { return shell.volume > 1e-9 * shell.magnitude; }
    bool is_enclosed(std::uint32_t root);
    std::optional<std::uint32_t> beyond(std::uint32_t root);

    const Scene& scene_;
    UnionFind sides_;
    std::map<std::uint32_t, Shell> shells_;
    std::map<std::uint32_t, bool> enclosed_;
    double tests_ = 0;
};

Regions::Regions(const Scene& scene) : scene_(scene), sides_(join_sides(scene))
{
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto& v = scene.triangles[t].vertices;
        for (const bool front : {true, false}) {
            const auto [entry, is_new] = shells_.try_emplace(sides_.root(side_of(t, front)));
            Shell& shell = entry->second;
            if (is_new) shell.base = shell.outermost = scene.vertices[v[0]];
            const Vec3 a = scene.vertices[v[0]] - shell.base, b = scene.vertices[v[1]] - shell.base,
                       c = scene.vertices[v[2]] - shell.base;
            const double term = glm::dot(a, glm::cross(b, c));
            shell.volume += front ? -term : term;
            shell.magnitude += std::abs(term);
            for (const std::uint32_t corner : v) {
                const Vec3& p = scene.vertices[corner];
                if (glm::dot(p, outward) > glm::dot(shell.outermost, outward)) shell.outermost = p;
            }
        }
    }
}

/// Where a ray from `p` along `outward` meets the triangle, in metres.
std::optional<double> hit(const Scene& scene, const SceneTriangle& triangle, const Vec3& p)
{
    const Vec3& a = scene.vertices[triangle.vertices[0]];
    const Vec3 e = scene.vertices[triangle.vertices[1]] - a, f = scene.vertices[triangle.vertices[2]] - a;
    const Vec3 q = glm::cross(outward, f);
    const double determinant = glm::dot(e, q);
    if (determinant == 0) return {};
    const double u = glm::dot(p - a, q) / determinant;
    if (!(u >= 0 && u <= 1)) return {};
    const Vec3 r = glm::cross(p - a, e);
    const double v = glm::dot(outward, r) / determinant;
    if (!(v >= 0 && u + v <= 1)) return {};
    return glm::dot(f, r) / determinant;
}

/// The shell that the ray from this shell's outermost vertex meets.
std::optional<std::uint32_t> Regions::beyond(std::uint32_t root)
{
    const Vec3 start = shells_.at(root).outermost;
    const double least = 1e-9 * scene_.diameter;
    std::optional<double> nearest;
    std::uint32_t met = 0;
    tests_ += static_cast<double>(scene_.triangles.size());
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
        const auto distance = hit(scene_, scene_.triangles[t], start);
        if (!distance || *distance <= least || (nearest && *distance >= *nearest)) continue;
        nearest = distance;
        const auto& v = scene_.triangles[t].vertices;
        const Vec3& a = scene_.vertices[v[0]];
        const Vec3 n = glm::cross(scene_.vertices[v[1]] - a, scene_.vertices[v[2]] - a);
        met = side_of(t, glm::dot(n, outward) < 0);
    }
    if (!nearest) return {};
    return sides_.root(met);
}

bool Regions::is_enclosed(std::uint32_t root)
{
    std::vector<std::uint32_t> passed;
    std::optional<std::uint32_t> at = root;
    bool answer = false;
    while (at) {
        if (const auto known = enclosed_.find(*at); known != enclosed_.end()) {
            answer = known->second;
            break;
        }
        if (encloses(shells_.at(*at))) {
            answer = enclosed_[*at] = true;
            break;
        }
        if (tests_ > most_tests || passed.size() > shells_.size()) break;
        passed.push_back(*at);
        at = beyond(*at);
    }
    for (const std::uint32_t shell : passed) enclosed_[shell] = answer;
    return answer;
}

bool Regions::all_light_enclosed()
{
    const bool lit = std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), [&](const Surface& surface) {
        return scene_.materials[surface.material.value].emits();
    });
    const auto matters = [&](SurfaceId surface) {
        return surface.valid() && (!lit || scene_.material_of(surface).emits());
    };
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
        const SceneTriangle& triangle = scene_.triangles[t];
        if (matters(triangle.front) && !is_enclosed(sides_.root(side_of(t, true)))) return false;
        if (matters(triangle.back) && !is_enclosed(sides_.root(side_of(t, false)))) return false;
    }
    return true;
}

}  // namespace

bool is_closed(const Scene& scene)
{
    return Regions(scene).all_light_enclosed();
}

}  // namespace patchlight
