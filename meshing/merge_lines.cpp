#include "meshing/merge_lines.h"

#include "meshing/box_pairs.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

using Interval = std::pair<double, double>;

int weakness(LineKind kind)
{
    return kind == LineKind::contact ? 0 : kind == LineKind::plane ? 1 : static_cast<int>(kind) + 1;
}

auto place(const SurfaceLine& l)
{
    return std::tuple(l.surface, l.start.x, l.start.y, l.end.x, l.end.y, weakness(l.kind));
}

double length_of(const SurfaceLine& l)
{
    return glm::length(l.end - l.start);
}

/// Ends in ascending order, so that a line and its reverse are the same.
void turn(SurfaceLine& l)
{
    if (std::tie(l.end.x, l.end.y) < std::tie(l.start.x, l.start.y)) std::swap(l.start, l.end);
}

/// Where a point is along a line, m, and how far off it.
Vec2 along_and_off(const SurfaceLine& l, const Vec2& p)
{
    const Vec2 u = (l.end - l.start) / length_of(l), q = p - l.start;
    return {glm::dot(u, q), u.x * q.y - u.y * q.x};
}

/// Whether the second lies on the straight line through the first.
bool continues(const SurfaceLine& line, const SurfaceLine& l, double near)
{
    return std::abs(along_and_off(line, l.start).y) <= near && std::abs(along_and_off(line, l.end).y) <= near;
}

/// Boxes in (angle, distance from the origin) that meet for lines that may be the same.
void add_boxes(const SurfaceLine& l, std::uint32_t index, double near, std::vector<Box3>& boxes,
               std::vector<std::uint32_t>& owners)
{
    const double length = length_of(l), far = std::max(glm::length(l.start), glm::length(l.end));
    const double tilt = 2 * near / length, slip = 2 * near + far * tilt;
    Vec2 u = (l.end - l.start) / length;
    if (u.y < 0) u = -u;
    const double angle = std::atan2(u.y, u.x), off = u.x * l.start.y - u.y * l.start.x;
    const auto add = [&](double theta, double sign) {
        const Vec3 middle(theta, sign * off, 0), half(tilt, slip, 0);
        boxes.push_back({middle - half, middle + half});
        owners.push_back(index);
    };
    add(angle, 1);
    // Just above 0 and just below π are near each other.
    if (angle < 0.9) add(angle + std::numbers::pi, -1);
}

std::vector<Interval> united(std::vector<Interval> parts, double near)
{
    std::ranges::sort(parts);
    std::vector<Interval> result;
    for (const Interval& p : parts) {
        if (result.empty() || p.first > result.back().second + near)
            result.push_back(p);
        else
            result.back().second = std::max(result.back().second, p.second);
    }
    return result;
}

std::vector<Interval> without(const std::vector<Interval>& parts, const std::vector<Interval>& taken)
{
    std::vector<Interval> result;
    for (auto [from, to] : parts) {
        for (const Interval& t : taken) {
            if (t.second <= from || t.first >= to) continue;
            if (t.first > from) result.emplace_back(from, t.first);
            from = t.second;
        }
        if (to > from) result.emplace_back(from, to);
    }
    return result;
}

/// One group of lines that are parts of one.
void merge_group(std::span<const SurfaceLine> lines, double near, std::vector<SurfaceLine>& result)
{
    const SurfaceLine& axis = lines.front();  // the longest
    if (lines.size() == 1) return result.push_back(axis);
    std::map<int, std::pair<LineKind, std::vector<Interval>>> by_kind;
    for (const SurfaceLine& l : lines) {
        const Interval ends = std::minmax(along_and_off(axis, l.start).x, along_and_off(axis, l.end).x);
        auto& [kind, parts] = by_kind[weakness(l.kind)];
        kind = l.kind;
        parts.push_back(ends);
    }
    const Vec2 u = (axis.end - axis.start) / length_of(axis);
    std::vector<Interval> taken;
    for (auto& [rank, entry] : by_kind) {
        const std::vector<Interval> parts = united(entry.second, near);
        for (const auto& [from, to] : without(parts, taken)) {
            if (to - from <= 4 * near) continue;
            // The longest keeps its own ends to the bit.
            const Vec2 start = std::abs(from) < 1e-4 * near ? axis.start : axis.start + from * u;
            const Vec2 end = std::abs(to - length_of(axis)) < 1e-4 * near ? axis.end : axis.start + to * u;
            result.push_back({axis.surface, entry.first, start, end});
        }
        taken.insert(taken.end(), parts.begin(), parts.end());
        taken = united(std::move(taken), near);
    }
}

/// Each line joins the longest one that it continues: not what it continues in turn, or short lines at a crossing would
/// join what crosses there.
void merge_surface(std::span<SurfaceLine> lines, double near, std::vector<SurfaceLine>& result)
{
    std::ranges::stable_sort(lines, std::greater{}, length_of);
    std::vector<Box3> boxes;
    std::vector<std::uint32_t> owners;
    for (std::uint32_t k = 0; k < lines.size(); ++k) add_boxes(lines[k], k, near, boxes, owners);
    std::vector<IndexPair> continued;  // a line, a longer one
    touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t j) {
        const auto [longer, shorter] = std::minmax(owners[i], owners[j]);
        if (longer != shorter && continues(lines[longer], lines[shorter], near))
            continued.emplace_back(shorter, longer);
        return false;
    });
    std::ranges::sort(continued);
    std::vector<std::uint32_t> group(lines.size());
    std::iota(group.begin(), group.end(), 0U);
    for (const auto& [shorter, longer] : continued)
        if (group[shorter] == shorter && group[longer] == longer) group[shorter] = longer;
    std::vector<std::vector<SurfaceLine>> members(lines.size());
    for (std::uint32_t k = 0; k < lines.size(); ++k) members[group[k]].push_back(lines[k]);
    for (const auto& parts : members)
        if (!parts.empty()) merge_group(parts, near, result);
}

bool on_border(const Scene& scene, const SurfaceLine& l, double near)
{
    const Surface& surface = scene.surface(l.surface);
    for (const auto& loop : surface.loops)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const SurfaceLine edge{l.surface, l.kind, surface.frame.to_plane(scene.vertices[loop[k]]),
                                   surface.frame.to_plane(scene.vertices[loop[(k + 1) % loop.size()]])};
            const Vec2 p = along_and_off(edge, l.start), q = along_and_off(edge, l.end);
            const auto within = [&](const Vec2& at) {
                return std::abs(at.y) <= near && at.x >= -near && at.x <= length_of(edge) + near;
            };
            if (within(p) && within(q)) return true;
        }
    return false;
}

}  // namespace

std::vector<SurfaceLine> merged_lines(const Scene& scene, std::vector<SurfaceLine> lines, double snap)
{
    const double near = 4 * snap;
    std::ranges::for_each(lines, turn);
    std::erase_if(lines, [&](const SurfaceLine& l) { return !(length_of(l) > 4 * near); });
    std::ranges::sort(lines, {}, place);
    const auto twins = [](const SurfaceLine& a, const SurfaceLine& b) {
        return a.surface == b.surface && a.start == b.start && a.end == b.end;  // the strongest comes first
    };
    lines.erase(std::unique(lines.begin(), lines.end(), twins), lines.end());
    std::vector<SurfaceLine> result;
    for (auto first = lines.begin(); first != lines.end();) {
        const auto last = std::find_if(first, lines.end(), [&](const auto& l) { return l.surface != first->surface; });
        merge_surface(std::span(first, last), near, result);
        first = last;
    }
    std::erase_if(result, [&](const SurfaceLine& l) { return on_border(scene, l, near); });
    std::ranges::for_each(result, turn);
    std::ranges::sort(result, {}, place);
    return result;
}

}  // namespace patchlight
