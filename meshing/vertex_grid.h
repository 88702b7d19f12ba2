#pragma once

#include "meshing/vectors.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace patchlight {

/// Finds the points within a distance of a place: cells as wide as the distance, hashed.
class VertexGrid {
public:
    explicit VertexGrid(double distance) : distance_(distance) {}

    void insert(const Vec3& p, std::uint32_t id) { cells_.emplace(key(cell(p)), Entry{p, id}); }

    /// The smallest id of those within the distance of p.
    std::optional<std::uint32_t> find(const Vec3& p) const
    {
        const Cell middle = cell(p);
        std::optional<std::uint32_t> best;
        for (int i = 0; i < 27; ++i) {
            const Cell at{middle.x + i % 3 - 1, middle.y + i / 3 % 3 - 1, middle.z + i / 9 - 1};
            const auto [first, last] = cells_.equal_range(key(at));
            for (auto entry = first; entry != last; ++entry) {
                if (glm::distance(entry->second.position, p) > distance_) continue;
                if (!best || entry->second.id < *best) best = entry->second.id;
            }
        }
        return best;
    }

private:
    struct Cell {
        std::int64_t x, y, z;
    };
    struct Entry {
        Vec3 position;
        std::uint32_t id;
    };
    Cell cell(const Vec3& p) const
    {
        const Vec3 c = glm::floor(p / distance_);
        return {static_cast<std::int64_t>(c.x), static_cast<std::int64_t>(c.y), static_cast<std::int64_t>(c.z)};
    }
    static std::uint64_t key(const Cell& c)
    {
        const auto mix = [](std::int64_t v, std::uint64_t factor) { return static_cast<std::uint64_t>(v) * factor; };
        return mix(c.x, 0x9E3779B97F4A7C15U) ^ mix(c.y, 0xC2B2AE3D27D4EB4FU) ^ mix(c.z, 0x165667B19E3779F9U);
    }

    double distance_;
    std::unordered_multimap<std::uint64_t, Entry> cells_;
};

/// Welds points with the vertices within a distance, and with one another, in an order that geometry decides. Appends
/// those that are new to `vertices`; gives each point's vertex.
inline std::vector<std::uint32_t> weld_points(const std::vector<Vec3>& points, double distance,
                                              std::vector<Vec3>& vertices)
{
    std::vector<std::uint32_t> order(points.size()), welded(points.size());
    if (points.empty()) return welded;
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(points[a].x, points[a].y, points[a].z) < std::tie(points[b].x, points[b].y, points[b].z);
    });
    VertexGrid grid(distance);
    for (std::uint32_t v = 0; v < vertices.size(); ++v) grid.insert(vertices[v], v);
    for (const std::uint32_t i : order) {
        const auto known = grid.find(points[i]);
        welded[i] = known ? *known : static_cast<std::uint32_t>(vertices.size());
        if (known) continue;
        vertices.push_back(points[i]);
        grid.insert(points[i], welded[i]);
    }
    return welded;
}

}  // namespace patchlight
