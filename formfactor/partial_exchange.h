#pragma once

#include "formfactor/blockers.h"
#include "formfactor/visible_part.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// Working memory of partial_exchange.
struct PartialScratch {
    VisibleScratch visible;
    std::vector<BlockerView> views;
    std::vector<std::array<std::vector<BlockerView>, 4>> quarters;  ///< the blockers of each, by level
    std::size_t nodes = 0;                                          ///< points clipped at since the scratch was made
};

/// A_1 F_12 of two small convex polygons partly hidden from each other, as a whole matrix needs it: the visible part of
/// the one is clipped at the nodes of a rule on the other (is_second_outer says which). The triangle is quartered while
/// that changes the value by more than `allowed` (absolute), at most four times; quarters whose own shaft is free or
/// covered are settled. Where many blockers stand in between both polygons are cut first, until each pair of pieces has
/// few. `free`: what would be exchanged with nothing in between. Where no node sees a cut, or none sees
/// anything, a fiftieth of `free` is taken for what may be missed; unlike occluded_exchange it looks for no shadow
/// events. Same conditions; swapping the polygons gives the same bits.
double partial_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                        const Vec3& normal_second, std::span<const Blocker> blockers,
                        std::span<const std::uint32_t> in_shaft, double snap, double free, double allowed,
                        PartialScratch& scratch);

}  // namespace patchlight
