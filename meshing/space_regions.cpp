#include "meshing/space_regions.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

/// In no way special, so that rays along it meet no edges of axis-aligned scenes.
const Vec3 outward = glm::normalize(Vec3{0.61330, 0.54171, 0.57489});

struct EdgeUse {
    std::uint32_t low, high;
    double angle;  ///< of the triangle, round the edge
    std::uint32_t triangle;
    bool ascending;  ///< the triangle runs from low to high
};

std::vector<EdgeUse> edge_uses(const std::vector<Vec3>& vertices,
                               const std::vector<std::array<std::uint32_t, 3>>& triangles)
{
    std::vector<EdgeUse> uses;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& v = triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = v[k], b = v[(k + 1) % 3];
            const std::uint32_t low = std::min(a, b), high = std::max(a, b);
            const Vec3 axis = glm::normalize(vertices[high] - vertices[low]);
            const Vec3 arm = vertices[v[(k + 2) % 3]] - vertices[low];
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

}  // namespace

SpaceRegions::SpaceRegions(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles, double diameter)
    : vertices_(vertices), triangles_(std::move(triangles)), diameter_(diameter), sides_(2 * triangles_.size())
{
    join_sides();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        for (const bool front : {true, false}) add_to_shell(t, front);
    }
}

/// Joins the sides that face each other round every edge.
void SpaceRegions::join_sides()
{
    const std::vector<EdgeUse> uses = edge_uses(vertices_, triangles_);
    for (std::size_t first = 0; first < uses.size();) {
        std::size_t last = first;
        while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) ++last;
        for (std::size_t i = first; i < last; ++i) {
            const EdgeUse& here = uses[i];
            const EdgeUse& next = uses[i + 1 < last ? i + 1 : first];
            // The normal of a triangle that runs along the edge points the way the angle grows.
            sides_.join(side_of(here.triangle, here.ascending), side_of(next.triangle, !next.ascending));
        }
        first = last;
    }
}

void SpaceRegions::add_to_shell(std::uint32_t triangle, bool front)
{
    const Triangle& v = triangles_[triangle];
    const auto [entry, is_new] = shells_.try_emplace(shell(triangle, front));
    Shell& shell = entry->second;
    if (is_new) {
        shell.base = vertices_[v[0]];
        shell.box = {shell.base, shell.base};
    }
    const Vec3 a = vertices_[v[0]] - shell.base, b = vertices_[v[1]] - shell.base, c = vertices_[v[2]] - shell.base;
    const double term = glm::dot(a, glm::cross(b, c));
    shell.volume += front ? -term : term;
    shell.magnitude += std::abs(term);
    for (const std::uint32_t corner : v) {
        shell.box.low = glm::min(shell.box.low, vertices_[corner]);
        shell.box.high = glm::max(shell.box.high, vertices_[corner]);
    }
    const Vec3 middle = (vertices_[v[0]] + vertices_[v[1]] + vertices_[v[2]]) / 3.0;
    if (runs_along_normal(triangle) == front && (!shell.start || glm::dot(middle - *shell.start, outward) > 0))
        shell.start = middle;
}

bool SpaceRegions::runs_along_normal(std::uint32_t triangle) const
{
    const Triangle& v = triangles_[triangle];
    const Vec3& a = vertices_[v[0]];
    return glm::dot(glm::cross(vertices_[v[1]] - a, vertices_[v[2]] - a), outward) > 0;
}

/// Where a ray from `p` along `outward` meets the triangle, in metres.
std::optional<double> SpaceRegions::hit(const Triangle& triangle, const Vec3& p) const
{
    const Vec3& a = vertices_[triangle[0]];
    const Vec3 e = vertices_[triangle[1]] - a, f = vertices_[triangle[2]] - a;
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

/// The shell that the ray from this shell's outermost triangle meets once it has left the shell itself for good. Not
/// from a vertex: what touches others, touches them there.
std::optional<std::uint32_t> SpaceRegions::beyond(std::uint32_t shell)
{
    const std::optional<Vec3>& start = shells_.at(shell).start;
    if (!start) return {};
    const double least = 1e-9 * diameter_;
    std::vector<std::pair<double, std::uint32_t>> met;
    tests_ += static_cast<double>(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        if (const auto distance = hit(triangles_[t], *start); distance && *distance > least)
            met.emplace_back(*distance, t);
    std::sort(met.begin(), met.end());
    std::size_t left = 0;
    for (std::size_t k = 0; k < met.size(); ++k)
        if (sides_.root(side_of(met[k].second, runs_along_normal(met[k].second))) == shell) left = k + 1;
    if (left == met.size()) return {};
    return sides_.root(side_of(met[left].second, !runs_along_normal(met[left].second)));
}

bool SpaceRegions::closes(std::uint32_t shell) const
{
    const Shell& one = shells_.at(shell);
    return one.volume > 1e-9 * one.magnitude;
}

std::optional<std::uint32_t> SpaceRegions::closing_shell(std::uint32_t shell)
{
    std::vector<std::uint32_t> passed;
    std::optional<std::uint32_t> at = shell, answer;
    while (at) {
        if (const auto known = closing_.find(*at); known != closing_.end()) {
            answer = known->second;
            break;
        }
        if (closes(*at)) {
            answer = closing_[*at] = at;
            break;
        }
        if (gave_up() || passed.size() > shells_.size()) break;
        passed.push_back(*at);
        at = beyond(*at);
    }
    for (const std::uint32_t one : passed) closing_[one] = answer;
    return answer;
}

}  // namespace patchlight
