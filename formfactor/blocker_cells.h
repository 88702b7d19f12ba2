#pragma once

#include "formfactor/blockers.h"
#include "meshing/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace patchlight {

/// A rectangle in a plane, along the frame's u and v.
struct PlaneRectangle {
    PlaneFrame frame;
    Vec2 low{0.0}, high{0.0};

    /// Counter-clockwise seen from the front.
    std::array<Vec3, 4> corners() const;
};

/// What may stand between the points of a rectangle and a convex polygon. The rectangle's blockers are found once by a
/// shaft query; cells of the rectangle, quartered while many blockers are left and quartering helps, keep those of
/// their parent's that are in their own shaft. Conservative: a cell's list lacks none that takes light from any of its
/// points.
class BlockerCells {
public:
    /// Everything hidden.
    BlockerCells() = default;
    /// No cell gets sides below `least_side` (m) by quartering.
    BlockerCells(const Blockers& blockers, const PlaneRectangle& from, const Facet& to, double least_side);

    /// Whether no point of the rectangle sees anything of the polygon.
    bool hidden() const { return cells_.empty() || cells_[0].count == all_hidden; }
    /// The blockers for a point of the plane, clipped as by Blockers::between; a point beside the rectangle has those
    /// of the nearest cell. False when nothing of the polygon is seen from there. `blockers`: those it was made with.
    bool find(const Vec3& x, const PlaneRectangle& from, const Blockers& blockers,
              std::vector<BlockerView>& views) const;

    std::size_t cell_count() const { return cells_.size(); }
    std::size_t bytes() const;

private:
    static constexpr std::uint32_t all_hidden = 0xffffffffU, quartered = 0xfffffffeU;
    /// A leaf has `count` blockers from list_[first] on. A quartered one has its quarters from cells_[first] on: low u
    /// and v, high u, high v, both high.
    struct Cell {
        std::uint32_t first = 0, count = all_hidden;
    };
    struct Builder;

    std::vector<Cell> cells_;
    std::vector<std::uint32_t> list_;  ///< index in Blockers::all(), or that many more in clipped_
    std::vector<Blocker> clipped_;     ///< what the planes of rectangle and polygon left of some
};

}  // namespace patchlight
