#pragma once

#include "formfactor/facets.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// Convex facets in a binary tree of axis-aligned boxes, for regions that no box describes well: cones, wedges.
/// All queries may be made from many threads at once.
class FacetTree {
public:
    /// Half-spaces: all p with dot(normal, p) ≥ offset.
    struct HalfSpace {
        Vec3 normal{0.0};
        double offset = 0;

        double most_in(const Vec3& middle, const Vec3& half) const
        {
            return glm::dot(normal, middle) + glm::dot(glm::abs(normal), half);
        }
    };

    explicit FacetTree(std::span<const Facet> facets);

    /// Calls visit(index) for every facet whose box may meet all of the half-spaces; stops when it returns false.
    template <class Visit>
    void visit(std::span<const HalfSpace> region, const Visit& visit) const
    {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, 64> stack;  // halves: deeper than 2^32 facets never
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!meets(node, region)) continue;
            if (node.right == 0) {
                for (std::uint32_t k = node.first; k < node.last; ++k)
                    if (!visit(order_[k])) return;
                continue;
            }
            stack[depth++] = node.right;
            stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
        }
    }

private:
    struct Node {
        Vec3 middle{0.0}, half{0.0};
        std::uint32_t first = 0, last = 0;  ///< range of order_
        std::uint32_t right = 0;            ///< the left child is the next node; 0 in a leaf
    };

    static bool meets(const Node& node, std::span<const HalfSpace> region)
    {
        return std::ranges::all_of(region,
                                   [&](const HalfSpace& h) { return h.most_in(node.middle, node.half) >= h.offset; });
    }
    void build(std::span<const Vec3> lows, std::span<const Vec3> highs, std::uint32_t first, std::uint32_t last);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace patchlight
