#include "meshing/arrange_lines.h"

#include "meshing/box_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

/// Rounds end when pieces do; this is for what rounding might chase in circles.
constexpr int most_rounds = 40;

/// How far a point may be from the border that it was put on: both are rounded to 2⁻³⁰.
constexpr double border_rounding = 2e-9;

/// The points, and which of them is near a place: a grid of cells as wide as `merge`.
class WeldedPoints {
public:
    WeldedPoints(const std::vector<Vec2>& given, double merge) : merge_(merge)
    {
        for (const Vec2& q : given) add(q);
    }

    /// The nearest point that will do, or a new one.
    template <class Accepted>
    std::uint32_t weld(const Vec2& place, const Accepted& accepted)
    {
        const Vec2 q = MeshingPlane::rounded(place);
        if (const auto near = nearest(q, accepted)) return *near;
        add(q);
        return static_cast<std::uint32_t>(points.size() - 1);
    }

    std::vector<Vec2> points;

private:
    using Cell = std::pair<std::int64_t, std::int64_t>;

    Cell cell_of(const Vec2& q) const
    {
        return {static_cast<std::int64_t>(std::floor(q.x / merge_)),
                static_cast<std::int64_t>(std::floor(q.y / merge_))};
    }

    void add(const Vec2& q)
    {
        cells_[cell_of(q)].push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(q);
    }

    template <class Accepted>
    std::optional<std::uint32_t> nearest(const Vec2& q, const Accepted& accepted) const
    {
        std::optional<std::uint32_t> best;
        double least = merge_;
        const auto [cx, cy] = cell_of(q);
        for (std::int64_t x = cx - 1; x <= cx + 1; ++x)
            for (std::int64_t y = cy - 1; y <= cy + 1; ++y) {
                const auto cell = cells_.find({x, y});
                if (cell == cells_.end()) continue;
                for (const std::uint32_t i : cell->second)
                    if (const double d = glm::distance(points[i], q); d < least && accepted(i)) {
                        least = d;
                        best = i;
                    }
            }
        return best;
    }

    double merge_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
};

/// Where two pieces cross, away from their ends. Coordinates that one of them holds fixed are taken from it.
std::optional<Vec2> crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
    const double ca = cross2(c, d, a), cb = cross2(c, d, b), ac = cross2(a, b, c), ad = cross2(a, b, d);
    if (!(ca * cb < 0 && ac * ad < 0)) return {};
    Vec2 point = a + ca / (ca - cb) * (b - a);
    for (int k = 0; k < 2; ++k) {
        if (a[k] == b[k]) point[k] = a[k];
        if (c[k] == d[k]) point[k] = c[k];
    }
    return point;
}

/// Pieces with the points that divide them.
class Divider {
public:
    Divider(LineArrangement given, double merge)
        : pieces_(std::move(given.pieces)), points_(given.points, merge), merge_(merge)
    {
        on_border_.resize(points_.points.size(), false);
        for (std::uint32_t k = 0; k < pieces_.size(); ++k) {
            if (!pieces_[k].border) continue;
            pieces_[k].origin = k;
            border_.push_back({at(pieces_[k].points[0]), at(pieces_[k].points[1])});
            for (const std::uint32_t point : pieces_[k].points) on_border_[point] = true;
        }
    }

    void add(const SurfaceLine& line)
    {
        const std::uint32_t start = weld(line.start), end = weld(line.end);
        pieces_.push_back({{start, end}, line.kind, false, 0});
    }

    void divide()
    {
        make_unique();
        for (int round = 0; round < most_rounds && divide_once(); ++round) make_unique();
    }
    LineArrangement result() { return {std::move(points_.points), std::move(pieces_)}; }

private:
    const Vec2& at(std::uint32_t point) const { return points_.points[point]; }

    std::uint32_t weld(const Vec2& place)
    {
        Vec2 nearest = place;
        double least = merge_;
        for (const auto& [a, b] : border_) {
            const double t = std::clamp(glm::dot(place - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
            const Vec2 on = a + t * (b - a);
            if (const double d = glm::distance(place, on); d < least) {
                least = d;
                nearest = on;
            }
        }
        const std::uint32_t point = points_.weld(nearest, [](std::uint32_t) { return true; });
        if (point == on_border_.size()) on_border_.push_back(least < merge_);
        return point;
    }

    /// A point of the border: the border never bends to one near it, on another border perhaps.
    std::uint32_t weld_on(const PlanePiece& border, const Vec2& place)
    {
        const std::uint32_t point = points_.weld(place, [&](std::uint32_t p) {
            return p == border.points[0] || p == border.points[1] || goes_past(border, p);
        });
        if (point == on_border_.size()) on_border_.push_back(true);
        return point;
    }

    void make_unique()
    {
        std::erase_if(pieces_, [](const PlanePiece& p) { return p.points[0] == p.points[1]; });
        const auto key = [](const PlanePiece& p) {
            const auto [low, high] = std::minmax(p.points[0], p.points[1]);
            return std::tuple(low, high, !p.border, p.kind, p.points[0]);
        };
        std::ranges::sort(pieces_, {}, key);
        // Two borders may run along one edge, one each way, where the surface touches itself.
        const auto same = [](const PlanePiece& p, const PlanePiece& q) {
            return std::minmax(p.points[0], p.points[1]) == std::minmax(q.points[0], q.points[1]) &&
                   !(p.border && q.border && p.points != q.points);
        };
        pieces_.erase(std::unique(pieces_.begin(), pieces_.end(), same), pieces_.end());
    }

    std::vector<Box3> piece_boxes() const
    {
        std::vector<Box3> boxes;
        for (const PlanePiece& p : pieces_) {
            const Vec2 low = glm::min(at(p.points[0]), at(p.points[1])) - merge_;
            const Vec2 high = glm::max(at(p.points[0]), at(p.points[1])) + merge_;
            boxes.push_back({{low.x, low.y, 0}, {high.x, high.y, 0}});
        }
        return boxes;
    }

    bool divide_once()
    {
        const std::vector<Box3> boxes = piece_boxes();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> divisions;  // of a piece, at a point
        std::vector<Box3> places;
        for (const Vec2& q : points_.points) places.push_back({{q.x, q.y, 0}, {q.x, q.y, 0}});
        touching_pairs(boxes, places, [&](std::uint32_t i, std::uint32_t point) {
            if (goes_past(pieces_[i], point)) divisions.emplace_back(i, point);
            return false;
        });
        // Crossings once no piece needs to bend any more: points on pieces come first.
        if (divisions.empty()) find_crossings(boxes, divisions);
        std::ranges::sort(divisions);
        apply(divisions);
        return !divisions.empty();
    }

    bool goes_past(const PlanePiece& piece, std::uint32_t point) const
    {
        if (piece.points[0] == point || piece.points[1] == point) return false;
        if (piece.border && !on_border_[point]) return false;
        const Vec2 &a = at(piece.points[0]), &b = at(piece.points[1]), &q = at(point);
        const double t = glm::dot(q - a, b - a) / glm::dot(b - a, b - a);
        return t > 0 && t < 1 && glm::distance(q, a + t * (b - a)) < (piece.border ? border_rounding : merge_);
    }

    void find_crossings(const std::vector<Box3>& boxes, std::vector<std::pair<std::uint32_t, std::uint32_t>>& divisions)
    {
        const auto pairs = touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t k) {
            const auto &p = pieces_[i].points, &q = pieces_[k].points;
            return p[0] != q[0] && p[0] != q[1] && p[1] != q[0] && p[1] != q[1] &&
                   crossing(at(p[0]), at(p[1]), at(q[0]), at(q[1])).has_value();
        });
        for (const auto& [i, k] : pairs) {
            const auto &p = pieces_[i].points, &q = pieces_[k].points;
            const Vec2 place = *crossing(at(p[0]), at(p[1]), at(q[0]), at(q[1]));
            const std::uint32_t point = pieces_[i].border   ? weld_on(pieces_[i], place)
                                        : pieces_[k].border ? weld_on(pieces_[k], place)
                                                            : weld(place);
            if (point != p[0] && point != p[1]) divisions.emplace_back(i, point);
            if (point != q[0] && point != q[1]) divisions.emplace_back(k, point);
        }
    }

    void apply(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& divisions)
    {
        for (std::size_t first = 0; first < divisions.size();) {
            std::size_t last = first;
            while (last < divisions.size() && divisions[last].first == divisions[first].first) ++last;
            const PlanePiece piece = pieces_[divisions[first].first];
            const Vec2 a = at(piece.points[0]), way = at(piece.points[1]) - a;
            std::vector<std::uint32_t> chain;
            for (std::size_t i = first; i < last; ++i) chain.push_back(divisions[i].second);
            std::ranges::sort(chain, {}, [&](std::uint32_t p) { return std::pair(glm::dot(at(p) - a, way), p); });
            chain.insert(chain.begin(), piece.points[0]);
            chain.push_back(piece.points[1]);
            pieces_[divisions[first].first].points = {chain[0], chain[1]};
            for (std::size_t i = 1; i + 1 < chain.size(); ++i)
                pieces_.push_back({{chain[i], chain[i + 1]}, piece.kind, piece.border, piece.origin});
            first = last;
        }
    }

    std::vector<PlanePiece> pieces_;
    WeldedPoints points_;
    std::vector<bool> on_border_;              ///< of each point
    std::vector<std::array<Vec2, 2>> border_;  ///< as it was given
    double merge_;
};

}  // namespace

LineArrangement arrange_lines(LineArrangement given, std::span<const SurfaceLine> lines, double merge)
{
    Divider divider(std::move(given), merge);
    for (const SurfaceLine& line : lines) divider.add(line);
    divider.divide();
    return divider.result();
}

}  // namespace patchlight
