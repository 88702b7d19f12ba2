#include "formfactor/corner_fan.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace patchlight {

namespace {

constexpr double full = 2 * std::numbers::pi;
constexpr double slack = 1e-9;  ///< of angles: neighbours share their edge exactly, but for rounding

std::array<FacetTree::HalfSpace, 6> box_around(const Vec3& p, double margin)
{
    std::array<FacetTree::HalfSpace, 6> region;
    for (int k = 0; k < 3; ++k) {
        Vec3 axis(0.0);
        axis[k] = 1;
        region[2 * k] = {axis, p[k] - margin};
        region[2 * k + 1] = {-axis, -p[k] - margin};
    }
    return region;
}

void add_sectors(const Facet& facet, const Vec3& point, double snap, CornerFan& fan)
{
    if (std::abs(glm::dot(facet.normal, point - facet.corners[0])) > snap) return;
    const std::size_t n = facet.corners.size();
    std::vector<std::array<Vec3, 2>> sectors;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3 p = facet.corners[k] - point, q = facet.corners[(k + 1) % n] - point;
        const double inside = glm::dot(glm::cross(q - p, -p), facet.normal);
        if (inside < -snap * glm::length(q - p)) return;
        // Seen from the point an edge through it spans nothing; the others span the facet.
        if (inside > snap * glm::length(q - p)) sectors.push_back({p, q});
    }
    fan.sectors.insert(fan.sectors.end(), sectors.begin(), sectors.end());
    fan.normals.push_back(facet.normal);
}

}  // namespace

CornerFan corner_fan(const FacetTree& tree, std::span<const Facet> facets, const Vec3& point, double snap)
{
    CornerFan fan;
    tree.visit(box_around(point, snap), [&](std::uint32_t f) {
        add_sectors(facets[f], point, snap, fan);
        return true;
    });
    return fan;
}

Outline CornerFan::outline(const Vec3& d) const
{
    const Vec3 axis = glm::normalize(d);
    const Vec3 other = std::abs(axis.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    std::vector<std::pair<double, double>> arcs;
    const auto angle = [&](const Vec3& p) { return std::atan2(glm::dot(v, p), glm::dot(u, p)); };
    for (const auto& [p, q] : sectors) {
        const double turn = glm::dot(glm::cross(p, q), axis);
        if (std::abs(turn) <= slack * glm::length(p) * glm::length(q)) continue;
        const double from = turn > 0 ? angle(p) : angle(q), to = turn > 0 ? angle(q) : angle(p);
        arcs.emplace_back(from, to < from ? to + full : to);
    }
    if (arcs.empty()) return Outline::corner;
    std::ranges::sort(arcs);
    std::vector<double> gaps;
    double until = arcs.front().second;
    for (const auto& [from, to] : arcs) {
        if (from > until + slack) gaps.push_back(from - until);
        until = std::max(until, to);
    }
    const double last = arcs.front().first + full - until;
    if (last > slack) gaps.push_back(last);
    if (gaps.empty()) return Outline::hidden;
    const bool straight = gaps.size() == 1 && std::abs(gaps[0] - std::numbers::pi) <= slack;
    return straight ? Outline::straight : Outline::corner;
}

}  // namespace patchlight
