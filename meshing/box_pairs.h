#pragma once

#include "meshing/vectors.h"

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace patchlight {

/// An axis-aligned box, closed.
struct Box3 {
    Vec3 low{0.0}, high{0.0};

    static Box3 around(std::span<const std::uint32_t> corners, const std::vector<Vec3>& vertices, double margin);
};

using IndexPair = std::pair<std::uint32_t, std::uint32_t>;
using PairTest = std::function<bool(std::uint32_t, std::uint32_t)>;

/// The pairs (first < second) of boxes that touch and pass the test, in ascending order. Near-linear in boxes + pairs.
std::vector<IndexPair> touching_pairs(const std::vector<Box3>& boxes, const PairTest& test);

/// The same between two sets: first is of `a`, second of `b`.
std::vector<IndexPair> touching_pairs(const std::vector<Box3>& a, const std::vector<Box3>& b, const PairTest& test);

}  // namespace patchlight
