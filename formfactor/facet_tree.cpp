#include "formfactor/facet_tree.h"

#include <numeric>

namespace patchlight {

namespace {

constexpr std::uint32_t leaf_size = 4;

}  // namespace

FacetTree::FacetTree(std::span<const Facet> facets) : order_(facets.size())
{
    std::vector<Vec3> lows, highs;
    for (const Facet& facet : facets) {
        Vec3 low = facet.corners[0], high = low;
        for (const Vec3& p : facet.corners) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        lows.push_back(low);
        highs.push_back(high);
    }
    std::iota(order_.begin(), order_.end(), 0U);
    if (!facets.empty()) build(lows, highs, 0, static_cast<std::uint32_t>(facets.size()));
}

void FacetTree::build(std::span<const Vec3> lows, std::span<const Vec3> highs, std::uint32_t first, std::uint32_t last)
{
    const std::size_t at = nodes_.size();
    Vec3 low = lows[order_[first]], high = highs[order_[first]];
    Vec3 least = low + high, most = least;  // twice the boxes' middles
    for (std::uint32_t k = first; k < last; ++k) {
        const std::uint32_t f = order_[k];
        low = glm::min(low, lows[f]);
        high = glm::max(high, highs[f]);
        least = glm::min(least, lows[f] + highs[f]);
        most = glm::max(most, lows[f] + highs[f]);
    }
    nodes_.push_back({0.5 * (low + high), 0.5 * (high - low), first, last, 0});
    if (last - first <= leaf_size) return;
    const Vec3 spread = most - least;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                     [&](std::uint32_t f, std::uint32_t g) {
                         const double a = lows[f][axis] + highs[f][axis], b = lows[g][axis] + highs[g][axis];
                         return a != b ? a < b : f < g;
                     });
    build(lows, highs, first, half);
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(lows, highs, half, last);
}

}  // namespace patchlight
