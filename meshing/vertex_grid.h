#pragma once

#include "meshing/vectors.h"

#include <glm/common.hpp>

#include <cstdint>
#include <optional>
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

}  // namespace patchlight
