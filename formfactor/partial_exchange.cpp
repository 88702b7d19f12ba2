#include "formfactor/partial_exchange.h"

#include "formfactor/triangle_rules.h"
#include "formfactor/unoccluded_exchange.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

constexpr std::size_t most_quarterings = 4;
constexpr std::size_t few_blockers = 3;    ///< looking again which of them matter to a quarter would cost more
constexpr std::size_t many_blockers = 20;  ///< cutting the polygons until fewer stand in each shaft costs less
constexpr int most_cuts = 6;
constexpr double unnoticed = 0.02;  ///< of the free exchange, where no node sees a difference

using Triangle = std::array<Vec3, 3>;
using Views = std::vector<BlockerView>;

/// The blockers in a smaller shaft, and what they make of it.
Visibility narrow(const Shaft& shaft, const Views& views, double snap, Views& rest)
{
    rest.clear();
    for (const BlockerView& blocker : views) {
        const Visibility past = visibility_past(shaft, blocker, snap);
        if (past == Visibility::hidden) return past;
        if (past == Visibility::partial) rest.push_back(blocker);
    }
    return rest.empty() ? Visibility::visible : Visibility::partial;
}

class PartialIntegral {
public:
    PartialIntegral(const Vec3& normal, std::span<const Vec3> target, const Vec3& target_normal, double snap,
                    PartialScratch& scratch)
        : normal_(normal), target_(target), target_normal_(target_normal), snap_(snap), scratch_(scratch)
    {
        scratch_.quarters.resize(most_quarterings);
    }

    /// Over a triangle that would exchange `free`.
    double over(const Triangle& t, double free, double allowed)
    {
        const double coarse = rule(t, scratch_.views);
        const bool clear_cut = !any_cut_ || coarse == 0;
        if (clear_cut && unnoticed * free <= allowed) return coarse;
        // Two rules can agree by chance: what weighs in its row is looked at twice.
        return quartered(t, scratch_.views, coarse, allowed, 0, unnoticed * free > 4 * allowed ? 2 : 1);
    }

private:
    double rule(const Triangle& t, const Views& views)
    {
        const Vec3 a = t[1] - t[0], b = t[2] - t[0];
        double mean = 0;
        for (const TriangleNode& node : triangle_rule(5)) {
            mean += node.weight *
                    visible_factor(t[0] + node.b1 * a + node.b2 * b, normal_, target_, views, scratch_.visible);
            any_cut_ = any_cut_ || scratch_.visible.cut;
        }
        scratch_.nodes += triangle_rule(5).size();
        return 0.5 * glm::length(glm::cross(a, b)) * mean;
    }

    double quartered(const Triangle& t, const Views& views, double coarse, double allowed, std::size_t level, int least)
    {
        const Vec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
        const std::array<Triangle, 4> quarters{{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {bc, ca, ab}}};
        std::array<double, 4> fine{};
        std::array<bool, 4> open{};
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            Views& rest = scratch_.quarters[level][k];
            const Visibility visibility =
                views.size() <= few_blockers ? Visibility::partial : narrow({quarters[k], target_}, views, snap_, rest);
            open[k] = visibility == Visibility::partial;
            if (visibility == Visibility::visible)
                fine[k] = unoccluded_exchange(quarters[k], normal_, target_, target_normal_);
            else if (open[k])
                fine[k] = rule(quarters[k], views.size() <= few_blockers ? views : rest);
            sum += fine[k];
        }
        if (level + 1 >= most_quarterings || (least <= 1 && std::abs(sum - coarse) <= allowed)) return sum;
        sum = 0;
        // Errors of quarters are as good as independent.
        for (std::size_t k = 0; k < 4; ++k)
            sum += open[k] ? quartered(quarters[k], views.size() <= few_blockers ? views : scratch_.quarters[level][k],
                                       fine[k], 0.5 * allowed, level + 1, least - 1)
                           : fine[k];
        return sum;
    }

    Vec3 normal_;
    std::span<const Vec3> target_;
    Vec3 target_normal_;
    double snap_;
    PartialScratch& scratch_;
    bool any_cut_ = false;
};

/// A polygon with the unit normal of its plane.
struct Side {
    Polygon corners;
    Vec3 normal;
};

class PartialPair {
public:
    PartialPair(double snap, PartialScratch& scratch) : snap_(snap), scratch_(scratch) {}

    /// Cuts the longer of both polygons in halves while many blockers stand in between.
    double over(const Side& a, const Side& b, const Views& views, double free, double allowed, int cuts)
    {
        if (views.size() <= many_blockers || cuts >= most_cuts) return integrated(a, b, views, free, allowed);
        const Vec3 extent_a = longest_extent(a.corners), extent_b = longest_extent(b.corners);
        const bool cut_a = glm::dot(extent_a, extent_a) > glm::dot(extent_b, extent_b);
        double sum = 0;
        for (const double side : {1.0, -1.0}) {
            Side half{{}, cut_a ? a.normal : b.normal};
            keep_half(cut_a ? a.corners : b.corners, side * (cut_a ? extent_a : extent_b), half.corners);
            if (half.corners.size() < 3) continue;
            const Side &first = cut_a ? half : a, &second = cut_a ? b : half;
            Views rest;
            const Visibility visibility = narrow({first.corners, second.corners}, views, snap_, rest);
            if (visibility == Visibility::hidden) continue;
            const double part = unoccluded_exchange(first.corners, first.normal, second.corners, second.normal);
            sum += visibility == Visibility::visible ? part : over(first, second, rest, part, allowed, cuts + 1);
        }
        return sum;
    }

private:
    double integrated(const Side& a, const Side& b, const Views& views, double free, double allowed)
    {
        const bool swapped = is_second_outer(a.corners, b.corners, views);
        const Side &outer = swapped ? b : a, &target = swapped ? a : b;
        scratch_.views = views;
        PartialIntegral integral(outer.normal, target.corners, target.normal, snap_, scratch_);
        double sum = 0;
        for (std::size_t i = 2; i < outer.corners.size(); ++i)
            sum += integral.over({outer.corners[0], outer.corners[i - 1], outer.corners[i]}, free, allowed);
        return std::min(sum, free);
    }

    double snap_;
    PartialScratch& scratch_;
};

}  // namespace

double partial_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                        const Vec3& normal_second, std::span<const Blocker> blockers,
                        std::span<const std::uint32_t> in_shaft, double snap, double free, double allowed,
                        PartialScratch& scratch)
{
    Views views;
    for (const std::uint32_t k : in_shaft) views.push_back(blockers[k].view());
    return PartialPair(snap, scratch)
        .over({Polygon(first.begin(), first.end()), normal_first},
              {Polygon(second.begin(), second.end()), normal_second}, views, free, allowed, 0);
}

}  // namespace patchlight
