#include "formfactor/partial_exchange.h"

#include "formfactor/triangle_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace patchlight {

namespace {

constexpr int most_quarterings = 4;
constexpr double unnoticed = 0.02;  ///< of the free exchange, where no node sees a difference


using Triangle = std::array<Vec3, 3>;

class PartialIntegral {
public:
    PartialIntegral(const Vec3& normal, std::span<const Vec3> target, PartialScratch& scratch)
        : normal_(normal), target_(target), scratch_(scratch)
    {}

    /// Over a triangle that would exchange `free`.
    double over(const Triangle& t, double free, double allowed)
    {
        const double coarse = rule(t, 5);
        const bool clear_cut = !any_cut_ || coarse == 0;
        if (clear_cut && unnoticed * free <= allowed) return coarse;
        // Two rules can agree by chance: what weighs in its row is looked at twice.
        return quartered(t, coarse, allowed, most_quarterings, unnoticed * free > 4 * allowed ? 2 : 1);
    }

private:
    double rule(const Triangle& t, int degree)
    {
        const Vec3 a = t[1] - t[0], b = t[2] - t[0];
        double mean = 0;
        for (const TriangleNode& node : triangle_rule(degree)) {
            mean += node.weight * visible_factor(t[0] + node.b1 * a + node.b2 * b, normal_, target_, scratch_.views,
                                                 scratch_.visible);
            any_cut_ = any_cut_ || scratch_.visible.cut;
        }
        scratch_.nodes += triangle_rule(degree).size();
        return 0.5 * glm::length(glm::cross(a, b)) * mean;
    }

    double quartered(const Triangle& t, double coarse, double allowed, int most, int least)
    {
        const Vec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
        const std::array<Triangle, 4> quarters{{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {bc, ca, ab}}};
        std::array<double, 4> fine{};
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += fine[k] = rule(quarters[k], 5);
        if (most <= 1 || (least <= 1 && std::abs(sum - coarse) <= allowed)) return sum;
        sum = 0;
        // Errors of quarters are as good as independent.
        for (std::size_t k = 0; k < 4; ++k) sum += quartered(quarters[k], fine[k], 0.5 * allowed, most - 1, least - 1);
        return sum;
    }

    Vec3 normal_;
    std::span<const Vec3> target_;
    PartialScratch& scratch_;
    bool any_cut_ = false;
};

/// The square of how far the nearest blocker's rim is from a polygon's middle.
double clearance(std::span<const Vec3> polygon, std::span<const BlockerView> blockers)
{
    Vec3 middle(0.0);
    for (const Vec3& p : polygon) middle += p / static_cast<double>(polygon.size());
    double nearest = std::numeric_limits<double>::infinity();
    for (const BlockerView& blocker : blockers)
        nearest = std::min(nearest, squared_distance_to_rim(middle, blocker.corners));
    return nearest;
}

}  // namespace

double partial_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                        const Vec3& normal_second, std::span<const Blocker> blockers,
                        std::span<const std::uint32_t> in_shaft, double free, double allowed, PartialScratch& scratch)
{
    scratch.views.clear();
    for (const std::uint32_t k : in_shaft) scratch.views.push_back(blockers[k].view());
    const bool swapped = clearance(first, scratch.views) < clearance(second, scratch.views);
    const std::span<const Vec3> outer = swapped ? second : first;
    PartialIntegral integral(swapped ? normal_second : normal_first, swapped ? first : second, scratch);
    double sum = 0;
    for (std::size_t i = 2; i < outer.size(); ++i)
        sum += integral.over({outer[0], outer[i - 1], outer[i]}, free, allowed);
    return std::min(sum, free);
}

}  // namespace patchlight
