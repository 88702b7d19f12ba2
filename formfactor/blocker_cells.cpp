#include "formfactor/blocker_cells.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace patchlight {

namespace {

/// A cell with this many or fewer is as fast as it need be.
constexpr std::size_t few = 4;
/// Quartering must leave at most this share of the blockers, in the mean.
constexpr double helps = 0.9;
/// What blockers may cross of a cell's shaft unnoticed, of the snapping distance. Cells end anywhere, not where
/// surfaces touch: rounding is all there is to forgive.
constexpr double sharp = 1e-4;

using Indices = std::vector<std::uint32_t>;

PlaneRectangle quarter(const PlaneRectangle& whole, unsigned k)
{
    const Vec2 middle = 0.5 * (whole.low + whole.high);
    PlaneRectangle result = whole;
    ((k & 1U) != 0 ? result.low : result.high).x = middle.x;
    ((k & 2U) != 0 ? result.low : result.high).y = middle.y;
    return result;
}

}  // namespace

std::array<Vec3, 4> PlaneRectangle::corners() const
{
    return {frame.lift(low), frame.lift({high.x, low.y}), frame.lift(high), frame.lift({low.x, high.y})};
}

struct BlockerCells::Builder {
    BlockerCells& cells;
    const std::vector<Blocker>& candidates;
    const Facet& to;
    std::span<const Vec3> front;  ///< what of `to` the rectangle's plane sees
    double snap, least_side;

    /// Which of some candidates are in the shaft of a cell.
    Visibility sift(const PlaneRectangle& cell, std::span<const std::uint32_t> some, Indices& found) const
    {
        found.clear();
        Polygon seeing;
        keep_front(cell.corners(), to.normal, glm::dot(to.normal, to.corners[0]), snap, seeing);
        if (seeing.size() < 3) return Visibility::hidden;
        const Shaft shaft{seeing, front};
        for (const std::uint32_t k : some) {
            const Visibility past = visibility_past(shaft, candidates[k].view(), sharp * snap);
            if (past == Visibility::hidden) return past;
            if (past == Visibility::partial) found.push_back(k);
        }
        return found.empty() ? Visibility::visible : Visibility::partial;
    }

    Cell leaf(Visibility visibility, const Indices& found) const
    {
        if (visibility == Visibility::hidden) return {};
        const Cell cell{static_cast<std::uint32_t>(cells.list_.size()), static_cast<std::uint32_t>(found.size())};
        cells.list_.insert(cells.list_.end(), found.begin(), found.end());
        return cell;
    }

    void fill(std::uint32_t index, const PlaneRectangle& cell, Visibility visibility, const Indices& found) const
    {
        const Vec2 side = cell.high - cell.low;
        if (found.size() > few && std::max(side.x, side.y) >= 2 * least_side && quartering(index, cell, found)) return;
        cells.cells_[index] = leaf(visibility, found);
    }

    bool quartering(std::uint32_t index, const PlaneRectangle& cell, const Indices& found) const
    {
        std::array<Indices, 4> kept;
        std::array<Visibility, 4> visibility{};
        std::size_t total = 0;
        for (unsigned k = 0; k < 4; ++k) {
            visibility[k] = sift(quarter(cell, k), found, kept[k]);
            if (visibility[k] == Visibility::hidden) kept[k].clear();
            total += kept[k].size();
        }
        if (static_cast<double>(total) > helps * 4 * static_cast<double>(found.size())) return false;
        const auto first = static_cast<std::uint32_t>(cells.cells_.size());
        cells.cells_[index] = {first, quartered};
        cells.cells_.resize(first + 4);
        for (unsigned k = 0; k < 4; ++k) fill(first + k, quarter(cell, k), visibility[k], kept[k]);
        return true;
    }

    /// From places among the candidates to blockers of all, or own ones where they are clipped.
    void name_blockers(std::span<const Blocker> all) const
    {
        Indices names;
        for (const Blocker& candidate : candidates) {
            if (candidate.corners == all[candidate.index].corners) {
                names.push_back(candidate.index);
                continue;
            }
            names.push_back(static_cast<std::uint32_t>(all.size() + cells.clipped_.size()));
            cells.clipped_.push_back(candidate);
        }
        for (std::uint32_t& k : cells.list_) k = names[k];
    }
};

BlockerCells::BlockerCells(const Blockers& blockers, const PlaneRectangle& from, const Facet& to, double least_side)
{
    const Vec3& n = from.frame.n;
    std::vector<Blocker> candidates;
    if (blockers.between(from.corners(), n, to.corners, to.normal, candidates) == Visibility::hidden) return;
    Polygon front;
    keep_front(to.corners, n, glm::dot(n, from.frame.origin), blockers.snap(), front);
    if (front.size() < 3) return;
    Indices all(candidates.size());
    for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    const Builder builder{*this, candidates, to, front, blockers.snap(), least_side};
    cells_.resize(1);
    builder.fill(0, from, candidates.empty() ? Visibility::visible : Visibility::partial, all);
    builder.name_blockers(blockers.all());
    cells_.shrink_to_fit();
    list_.shrink_to_fit();
    clipped_.shrink_to_fit();
}

bool BlockerCells::find(const Vec3& x, const PlaneRectangle& from, const Blockers& blockers,
                        std::vector<BlockerView>& views) const
{
    views.clear();
    if (cells_.empty()) return false;
    const Vec2 q = from.frame.to_plane(x);
    Vec2 low = from.low, high = from.high;
    Cell cell = cells_[0];
    while (cell.count == quartered) {
        const Vec2 middle = 0.5 * (low + high);
        const bool right = q.x >= middle.x, up = q.y >= middle.y;
        (right ? low : high).x = middle.x;
        (up ? low : high).y = middle.y;
        cell = cells_[cell.first + (right ? 1U : 0U) + (up ? 2U : 0U)];
    }
    if (cell.count == all_hidden) return false;
    const std::span<const Blocker> all = blockers.all();
    for (std::uint32_t k = cell.first; k < cell.first + cell.count; ++k)
        views.push_back((list_[k] < all.size() ? all[list_[k]] : clipped_[list_[k] - all.size()]).view());
    return true;
}

std::size_t BlockerCells::bytes() const
{
    return cells_.capacity() * sizeof(Cell) + list_.capacity() * sizeof(std::uint32_t) +
           clipped_.capacity() * sizeof(Blocker);
}

}  // namespace patchlight
