#include "formfactor/occluded_exchange.h"

#include "formfactor/polygon_factor.h"
#include "formfactor/shadow_events.h"
#include "formfactor/triangle_rules.h"
#include "formfactor/visible_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace patchlight {

namespace {

/// Cells cut along events before anything is integrated, and what nodes each is allowed for.
constexpr std::size_t most_first_cells = 20000, nodes_of_a_cell = 160;
/// What part of a cell's unoccluded light may be missed where an event crosses it unnoticed.
constexpr double event_risk = 0.05;

/// Area over the square of the length below which a cell is a sliver.
constexpr double sliver = 1e-7;

struct Cell {
    std::vector<Vec2> corners;
    std::vector<std::uint32_t> blockers, events;
    double area = 0, value = 0, error = 0;
};

double area_of(const std::vector<Vec2>& polygon)
{
    double twice = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) twice += cross2(polygon[0], polygon[i - 1], polygon[i]);
    return 0.5 * twice;
}

/// What of a convex polygon lies where dot(normal, q) ≥ offset.
std::vector<Vec2> half_of(const std::vector<Vec2>& polygon, const Vec2& normal, double offset)
{
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double hp = glm::dot(normal, p) - offset, hq = glm::dot(normal, q) - offset;
        if (hp >= 0) kept.push_back(p);
        if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) kept.push_back(p + (hp / (hp - hq)) * (q - p));
    }
    return kept;
}

class OccludedIntegral {
public:
    OccludedIntegral(std::span<const Vec3> outer, const Vec3& normal, std::span<const Vec3> target,
                     const Vec3& target_normal, std::span<const Blocker> blockers, double snap,
                     const OccludedOptions& options)
        : normal_(normal), target_(target), target_normal_(target_normal), blockers_(blockers), snap_(snap),
          options_(options)
    {
        // Not the first edge: of what clipping leaves it may have no length.
        const Vec3 along = glm::normalize(longest_extent(outer));
        plane_ = {outer[0], along, glm::cross(normal, along)};
        Cell whole;
        for (const Vec3& p : outer)
            whole.corners.emplace_back(glm::dot(p - plane_.origin, plane_.u), glm::dot(p - plane_.origin, plane_.v));
        whole.area = area_of(whole.corners);
        least_ = 1e-11 * std::sqrt(whole.area);
        for (std::uint32_t k = 0; k < blockers.size(); ++k) whole.blockers.push_back(k);
        events_ = shadow_events(plane_, whole.corners, target, blockers);
        for (std::uint32_t k = 0; k < events_.size(); ++k) whole.events.push_back(k);
        pending_.push_back(std::move(whole));
    }

    ExchangeEstimate run()
    {
        cut_along_events();
        fair_share_ = 0.3 * options_.tolerance / static_cast<double>(std::max<std::size_t>(100, pending_.size()));
        for (Cell& cell : pending_) integrate(cell);
        const auto less = [](const Cell& a, const Cell& b) { return a.error < b.error; };
        std::ranges::make_heap(pending_, less);
        double error = 0;
        for (const Cell& cell : pending_) error += cell.error;
        while (error > options_.tolerance && nodes_ < options_.max_nodes && !pending_.empty()) {
            std::ranges::pop_heap(pending_, less);
            Cell cell = std::move(pending_.back());
            pending_.pop_back();
            error -= cell.error;
            for (Cell& child : halves(cell)) {
                if (is_settled(child)) continue;
                integrate(child);
                error += child.error;
                pending_.push_back(std::move(child));
                std::ranges::push_heap(pending_, less);
            }
        }
        return result();
    }

private:
    /// Along one event after the other, as long as cells are few; whatever is free or covered is settled on the way.
    void cut_along_events()
    {
        std::vector<Cell> open = std::move(pending_);
        pending_.clear();
        const std::size_t most = std::min(most_first_cells, options_.max_nodes / nodes_of_a_cell);
        while (!open.empty()) {
            Cell cell = std::move(open.back());
            open.pop_back();
            if (is_settled(cell)) continue;
            if (cell.events.empty() || cell.area <= 3 * options_.tolerance || open.size() + pending_.size() > most) {
                pending_.push_back(std::move(cell));
                continue;
            }
            for (Cell& child : halves(cell)) open.push_back(std::move(child));
        }
    }

    /// Whether the cell's own shaft is free, or covered by one blocker: then its value is exact.
    bool is_settled(Cell& cell)
    {
        Polygon corners;
        for (const Vec2& q : cell.corners) corners.push_back(plane_.lift(q));
        const Shaft shaft{corners, target_};
        bool covered = false;
        std::erase_if(cell.blockers, [&](std::uint32_t k) {
            const Visibility past = visibility_past(shaft, blockers_[k].view(), snap_);
            covered = covered || past == Visibility::hidden;
            return past == Visibility::visible;
        });
        if (covered) return true;
        if (!cell.blockers.empty()) return false;
        settled_ += free_exchange(cell, corners);
        return true;
    }

    /// Contours cancel around a sliver: its light is taken at nodes, which its small area makes exact enough.
    double free_exchange(const Cell& cell, const Polygon& corners)
    {
        double square = 0;
        for (const Vec3& p : corners)
            for (const Vec3& q : corners) square = std::max(square, glm::dot(q - p, q - p));
        ++nodes_;
        if (cell.area > sliver * square) return fragment_exchange(corners, normal_, target_, target_normal_, 1e-13);
        views_.clear();
        return rule(cell, triangle_rule(8));
    }

    bool crosses(const ShadowEvent& event, const Cell& cell) const
    {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const Vec2& q : cell.corners) {
            const double h = glm::dot(event.normal, q) - event.offset;
            least = std::min(least, h);
            most = std::max(most, h);
        }
        if (!(least < -least_ && most > least_)) return false;
        double from = 0, to = 1;
        for (std::size_t i = 0; i < cell.corners.size(); ++i) {
            const Vec2 &p = cell.corners[i], &q = cell.corners[(i + 1) % cell.corners.size()];
            const double w0 = cross2(p, q, event.start), w1 = cross2(p, q, event.end);
            if (w0 <= 0 && w1 <= 0) return false;
            if (w0 < 0) from = std::max(from, w0 / (w0 - w1));
            if (w1 < 0) to = std::min(to, w0 / (w0 - w1));
        }
        return (to - from) * glm::length(event.end - event.start) > least_;
    }

    /// Two parts: along the event that halves the cell best, or across its greatest length.
    std::vector<Cell> halves(const Cell& cell) const
    {
        Vec2 normal(0.0), centre(0.0);
        for (const Vec2& q : cell.corners) centre += q / static_cast<double>(cell.corners.size());
        double offset = 0, nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t k : cell.events) {
            const double distance = std::abs(glm::dot(events_[k].normal, centre) - events_[k].offset);
            if (distance >= nearest) continue;
            nearest = distance;
            normal = events_[k].normal;
            offset = events_[k].offset;
        }
        if (cell.events.empty()) {
            double longest = 0;
            for (const Vec2& p : cell.corners)
                for (const Vec2& q : cell.corners)
                    if (const double length = glm::length(q - p); length > longest) {
                        longest = length;
                        normal = (q - p) / length;
                    }
            offset = glm::dot(normal, centre);
        }
        std::vector<Cell> children;
        for (const double side : {1.0, -1.0}) {
            Cell child;
            child.corners = half_of(cell.corners, side * normal, side * offset);
            child.area = child.corners.size() >= 3 ? area_of(child.corners) : 0;
            if (!(child.area > least_ * least_)) continue;
            child.blockers = cell.blockers;
            for (const std::uint32_t k : cell.events)
                if (crosses(events_[k], child)) child.events.push_back(k);
            children.push_back(std::move(child));
        }
        return children;
    }

    double rule(const Cell& cell, std::span<const TriangleNode> nodes)
    {
        double sum = 0;
        for (std::size_t i = 2; i < cell.corners.size(); ++i) {
            const Vec2 &a = cell.corners[0], &b = cell.corners[i - 1], &c = cell.corners[i];
            const double area = 0.5 * cross2(a, b, c);
            double mean = 0;
            for (const TriangleNode& node : nodes)
                mean += node.weight * visible_factor(plane_.lift(a + node.b1 * (b - a) + node.b2 * (c - a)), normal_,
                                                     target_, views_, scratch_);
            sum += area * mean;
            nodes_ += nodes.size();
        }
        return sum;
    }

    /// Whether the cell is larger than its distance from an edge that its integrand sees: that is where its analytic
    /// continuation ends.
    bool is_near(const Cell& cell) const
    {
        Vec2 centre(0.0);
        for (const Vec2& q : cell.corners) centre += q / static_cast<double>(cell.corners.size());
        double square = 0;
        for (const Vec2& q : cell.corners) square = std::max(square, glm::dot(q - centre, q - centre));
        const Vec3 middle = plane_.lift(centre);
        return squared_distance_to_rim(middle, target_) < 4 * square ||
               std::ranges::any_of(cell.blockers, [&](std::uint32_t k) {
                   return squared_distance_to_rim(middle, blockers_[k].corners) < 4 * square;
               });
    }

    /// The rules of degree 5 and 8 where their difference is a cell's fair share of the tolerance, else one more.
    void apply_rules(Cell& cell)
    {
        const bool poor = options_.max_nodes < nodes_of_a_cell;  // then two cheap rules are what there is
        const double low = rule(cell, triangle_rule(poor ? 2 : 5)), middle = rule(cell, triangle_rule(poor ? 5 : 8));
        cell.value = middle;
        cell.error = std::abs(middle - low);
        if (cell.error <= fair_share_ || nodes_ >= options_.max_nodes) return;
        cell.value = rule(cell, triangle_rule(12));
        const double difference = std::abs(cell.value - low);
        // Where the integrand is steep two rules can agree by chance: then the worse counts.
        cell.error = std::max(difference, std::abs(cell.value - middle));
        if (is_near(cell) || !cell.events.empty() || cell.blockers.size() > 1) return;
        // Analytic: then twice the order leaves about the square; half of that exponent is on the safe side.
        const double scale = std::max({std::abs(cell.value), std::abs(low), 1e-300});
        cell.error = difference * std::sqrt(std::min(1.0, difference / scale));
    }

    void integrate(Cell& cell)
    {
        views_.clear();
        for (const std::uint32_t k : cell.blockers) views_.push_back(blockers_[k].view());
        apply_rules(cell);
        if (!cell.events.empty()) {
            views_.clear();
            const double free = rule(cell, triangle_rule(1));
            cell.error += event_risk * std::min(std::abs(free), std::abs(free - cell.value));
            cell.error += event_risk * event_risk * free;
        }
    }

    ExchangeEstimate result() const
    {
        // Small values first: the sum then depends on the cells alone.
        std::vector<double> values;
        ExchangeEstimate sum{settled_, 0, nodes_};
        for (const Cell& cell : pending_) {
            values.push_back(cell.value);
            sum.error += cell.error;
        }
        std::ranges::sort(values);
        for (const double value : values) sum.value += value;
        return sum;
    }

    Vec3 normal_;
    std::span<const Vec3> target_;
    Vec3 target_normal_;
    std::span<const Blocker> blockers_;
    double snap_;
    OccludedOptions options_;
    OuterPlane plane_;
    double least_ = 0;  ///< lengths below are rounding
    std::vector<ShadowEvent> events_;
    std::vector<Cell> pending_;
    double settled_ = 0, fair_share_ = 0;
    std::size_t nodes_ = 0;
    std::vector<BlockerView> views_;
    VisibleScratch scratch_;
};

}  // namespace

ExchangeEstimate occluded_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                                   const Vec3& normal_second, std::span<const Blocker> blockers, double snap,
                                   const OccludedOptions& options)
{
    std::vector<BlockerView> views;
    for (const Blocker& blocker : blockers) views.push_back(blocker.view());
    if (is_second_outer(first, second, views))
        return OccludedIntegral(second, normal_second, first, normal_first, blockers, snap, options).run();
    return OccludedIntegral(first, normal_first, second, normal_second, blockers, snap, options).run();
}

}  // namespace patchlight
