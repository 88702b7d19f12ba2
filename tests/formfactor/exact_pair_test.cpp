#include "formfactor/blockers.h"
#include "formfactor/lambert.h"
#include "formfactor/occluded_exchange.h"
#include "formfactor/polygon_factor.h"
#include "formfactor/random_numbers.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

namespace patchlight {
namespace {

using Corners = std::vector<Vec3>;

// Sanitizers look at what is done, not at rare values, and take twenty times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

Corners rectangle(double x0, double x1, double y0, double y1, double z)
{
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

Corners reversed(Corners corners)
{
    std::ranges::reverse(corners);
    return corners;
}

Vec3 normal_of(const Corners& c)
{
    return glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
}

/// Turned, scaled, moved.
struct Pose {
    std::array<Vec3, 3> axes{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    double scale = 1;
    Vec3 move{0.0};

    Corners operator()(const Corners& corners) const
    {
        Corners result;
        for (const Vec3& p : corners) result.push_back(scale * (p.x * axes[0] + p.y * axes[1] + p.z * axes[2]) + move);
        return result;
    }
};

Pose random_pose(RandomNumbers& random, double scale)
{
    const auto any = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5; };
    const Vec3 u = glm::normalize(any()), v = glm::normalize(glm::cross(u, any()));
    return {{u, v, glm::cross(u, v)}, scale, scale * any()};
}

Blocker blocker_of(const Corners& corners)
{
    const Vec3 n = normal_of(corners);
    Blocker blocker;
    blocker.corners.assign(corners.begin(), corners.end());
    blocker.normal = n;
    blocker.offset = glm::dot(n, corners[0]);
    return blocker;
}

double area_of(const Corners& p)
{
    Vec3 twice(0.0);
    for (std::size_t k = 2; k < p.size(); ++k) twice += glm::cross(p[k - 1] - p[0], p[k] - p[0]);
    return 0.5 * glm::length(twice);
}

struct Case {
    Corners from, to;
    std::vector<Corners> blockers;
};

/// F from → to, and what was done for it.
ExchangeEstimate factor(const Case& c, const Pose& pose = {}, double tolerance = 1e-11)
{
    const Corners a = pose(c.from), b = pose(c.to);
    std::vector<Blocker> way, found;
    for (const Corners& corners : c.blockers) way.push_back(blocker_of(pose(corners)));
    const Blockers blockers(std::move(way), 2 * pose.scale);
    const Vec3 na = normal_of(a), nb = normal_of(b);
    const double area = area_of(a);
    const Visibility visibility = blockers.between(a, na, b, nb, found);
    if (visibility == Visibility::hidden) return {};
    if (visibility == Visibility::visible) return {polygon_factor(a, b, 1e-13), 0, 0};
    Polygon front_a, front_b;
    keep_front(a, nb, glm::dot(nb, b[0]), blockers.snap(), front_a);
    keep_front(b, na, glm::dot(na, a[0]), blockers.snap(), front_b);
    ExchangeEstimate e = occluded_exchange(front_a, na, front_b, nb, found, blockers.snap(),
                                           {.tolerance = tolerance * pose.scale * pose.scale});
    e.value /= area;
    e.error /= area;
    return e;
}

/// Opposed unit squares at distance 1.
Case opposed(std::vector<Corners> blockers)
{
    return {rectangle(0, 1, 0, 1, 0), reversed(rectangle(0, 1, 0, 1, 1)), std::move(blockers)};
}

struct Known {
    const char* name;
    Corners blocker;
    double F;
};

// reference-values.md §2.
const std::vector<Known> known{{"a quarter, halfway", rectangle(0, .5, 0, .5, .5), 0.149868671773790537},
                               {"the middle, low", rectangle(.25, .75, .25, .75, .25), 0.115620602132415},
                               {"a half, halfway", rectangle(0, .5, 0, 1, .5), 0.0999124478491936915}};

// The issue asks for 1e-9; with 1e-11 asked of the integral, what is left is its estimate's optimism.
TEST(ExactPair, PartlyHiddenSquaresOfTheReference)
{
    for (const Known& k : known) {
        const ExchangeEstimate e = factor(opposed({k.blocker}));
        EXPECT_NEAR(e.value, k.F, 1e-10) << k.name;
        EXPECT_LE(e.error, 1e-11) << k.name;
        EXPECT_LT(e.nodes, 100000U) << k.name;
    }
}

TEST(ExactPair, AnyPlaceTurnAndScaleGivesTheSame)
{
    RandomNumbers random(7, 1);
    for (const Known& k : known)
        for (const double scale : {1e-3, 1.0, 1e3})
            for (int turn = 0; turn < 3; ++turn)
                EXPECT_NEAR(factor(opposed({k.blocker}), random_pose(random, scale)).value, k.F, 1e-9) << k.name;
}

// One order is chosen for both ways round: the same bits.
TEST(ExactPair, IsReciprocal)
{
    for (const Known& k : known) {
        Case c = opposed({k.blocker});
        const double there = factor(c).value;
        std::swap(c.from, c.to);
        EXPECT_EQ(factor(c).value, there) << k.name;
    }
}

// Every ray crosses the plug or passes beside it: with the plug, plus through a frame that leaves just its place, is
// all there is. Nothing of this is shared with the reference values.
TEST(ExactPair, APlugAndTheFrameAroundItMakeTheWhole)
{
    const double free = polygon_factor(rectangle(0, 1, 0, 1, 0), reversed(rectangle(0, 1, 0, 1, 1)), 1e-13);
    RandomNumbers random(3, 5);
    for (int i = 0; i < 12; ++i) {
        const double x0 = 0.6 * random.uniform(), x1 = x0 + 0.05 + 0.3 * random.uniform();
        const double y0 = 0.6 * random.uniform(), y1 = y0 + 0.05 + 0.3 * random.uniform();
        const double z = 0.05 + 0.9 * random.uniform();
        const double plugged = factor(opposed({rectangle(x0, x1, y0, y1, z)})).value;
        const double framed = factor(opposed({rectangle(-9, x0, -9, 9, z), rectangle(x1, 9, -9, 9, z),
                                              rectangle(x0, x1, -9, y0, z), rectangle(x0, x1, y1, 9, z)}))
                                  .value;
        EXPECT_NEAR(plugged + framed, free, 1e-9) << i;
    }
}

// How a blocker is cut into polygons, and in which order they come, is no matter.
TEST(ExactPair, PiecesOfABlockerHideWhatItHides)
{
    const Corners q = rectangle(.2, .7, .3, .8, .4);
    const double whole = factor(opposed({q})).value;
    const Corners one{q[0], q[1], q[2]}, two{q[0], q[2], q[3]};
    EXPECT_NEAR(factor(opposed({one, two})).value, whole, 1e-9);
    EXPECT_NEAR(factor(opposed({two, one})).value, whole, 1e-9);
    EXPECT_NEAR(factor(opposed({q, q, reversed(q)})).value, whole, 1e-9) << "the same one again";
    // Overlapping halves, and one behind the other's shadow.
    EXPECT_NEAR(factor(opposed({rectangle(.2, .5, .3, .8, .4), rectangle(.4, .7, .3, .8, .4)})).value, whole, 1e-9);
}

/// The light that passes the slit [x0, x1] × everything at height z, from rectangles alone: at each place below, what
/// is seen of the ceiling through it is a rectangle.
double through_slit(double x0, double x1, double z)
{
    constexpr int panels = 400;
    const double root = std::sqrt(1.0 / 3);
    double sum = 0;
    for (int i = 0; i < panels; ++i)
        for (const double gx : {-root, root})
            for (int j = 0; j < 40; ++j)
                for (const double gy : {-root, root}) {
                    const double x = (i + 0.5 + 0.5 * gx) / panels, y = (j + 0.5 + 0.5 * gy) / 40;
                    const double left = std::clamp(x + (x0 - x) / z, 0.0, 1.0);
                    const double right = std::clamp(x + (x1 - x) / z, 0.0, 1.0);
                    if (right > left)
                        sum += lambert_factor({x, y, 0}, {0, 0, 1}, reversed(rectangle(left, right, 0, 1, 1)));
                }
    return sum / (4 * panels * 40);
}

// A slit of a thousandth must not be lost, nor one of a millionth.
TEST(ExactPair, ASliverIsFound)
{
    for (const double width : {1e-2, 1e-3, 1e-6}) {
        const double x0 = .5 - width / 2, x1 = .5 + width / 2;
        for (const double tolerance : {1e-6, 1e-8, 1e-11}) {
            const ExchangeEstimate e =
                factor(opposed({rectangle(-9, x0, -9, 9, .5), rectangle(x1, 9, -9, 9, .5)}), {}, tolerance);
            EXPECT_GT(e.value, 0) << width << ' ' << tolerance;
        }
    }
    // Two nodes a panel leave 1e-5 of it where the ceiling's edge shows through the slit.
    const double exact = factor(opposed({rectangle(-9, .495, -9, 9, .5), rectangle(.505, 9, -9, 9, .5)})).value;
    EXPECT_NEAR(exact, through_slit(.495, .505, .5), 1e-4 * exact);
}

TEST(ExactPair, HiddenBehindOneOrBetweenManyIsNothing)
{
    EXPECT_EQ(factor(opposed({rectangle(-9, 9, -9, 9, .5)})).value, 0);
    // Two halves that overlap: no single one covers.
    EXPECT_LT(factor(opposed({rectangle(-9, .6, -9, 9, .5), rectangle(.4, 9, -9, 9, .5)})).value, 1e-11);
    // Halves that just touch.
    EXPECT_LT(factor(opposed({rectangle(-9, .5, -9, 9, .5), rectangle(.5, 9, -9, 9, .5)})).value, 1e-11);
}

// A wall standing on the floor between floor and the wall behind it: blocker, contact and shared edge at once. Both
// halves of the floor see the wall as from two separate scenes.
TEST(ExactPair, AWallStandingOnTheReceiver)
{
    const Corners floor = rectangle(0, 1, 0, 1, 0), back{{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
    const Corners plate{{.5, 0, 0}, {.5, 1, 0}, {.5, 1, .5}, {.5, 0, .5}};
    const Corners before = rectangle(0, .5, 0, 1, 0), behind = rectangle(.5, 1, 0, 1, 0);
    const double whole = factor({floor, back, {plate}}).value;
    const double parts = 0.5 * factor({before, back, {plate}}).value + 0.5 * factor({behind, back, {plate}}).value;
    EXPECT_NEAR(whole, parts, 1e-9);
    EXPECT_EQ(factor({behind, back, {plate}}).value, polygon_factor(behind, back, 1e-13)) << "it stands behind";
}

// Polygons that pierce each other see each other's front part only.
TEST(ExactPair, PolygonsThatCross)
{
    const Corners flat = rectangle(0, 1, 0, 1, 0), upright{{.5, 0, -1}, {.5, 0, 1}, {.5, 1, 1}, {.5, 1, -1}};
    const Corners half = rectangle(0, .5, 0, 1, 0), above{{.5, 0, 0}, {.5, 0, 1}, {.5, 1, 1}, {.5, 1, 0}};
    EXPECT_NEAR(factor({flat, upright, {flat, upright}}).value, 0.5 * polygon_factor(half, above, 1e-13), 1e-10);
}

Corners random_polygon(RandomNumbers& random, double size, const Vec3& centre)
{
    const auto any = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5; };
    const Vec3 u = glm::normalize(any()), v = glm::normalize(glm::cross(u, any()));
    const int n = 3 + static_cast<int>(random.below(3));
    const double stretch = std::pow(10.0, -2 * random.uniform()), start = random.uniform();
    Corners corners;
    for (int k = 0; k < n; ++k) {
        const double phi = 2 * std::numbers::pi * (k + 0.4 * random.uniform() + start) / n;
        corners.push_back(centre + size * (std::cos(phi) * u + stretch * std::sin(phi) * v));
    }
    return corners;
}

// Any pair, any blockers, thin ones too: 0 ≤ F ≤ 1, never more than with nothing in between (to the tolerance asked),
// reciprocal. 100,000 pairs.
TEST(ExactPair, InvariantsOfRandomPairs)
{
    constexpr int pairs = sanitized ? 5000 : 100000;
    constexpr double tolerance = 1e-4;
    std::atomic<int> partial{0}, wrong{0};
    tbb::parallel_for(0, pairs, [&](int i) {
        RandomNumbers random(11, static_cast<std::uint64_t>(i));
        const auto any = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5; };
        Case c{
            random_polygon(random, 0.5, any()), random_polygon(random, 0.5, any() + Vec3(0, 0, random.uniform())), {}};
        const double from_area = area_of(c.from), to_area = area_of(c.to);
        const double free = polygon_factor(c.from, c.to, 1e-9), back = polygon_factor(c.to, c.from, 1e-9);
        const double reciprocal = std::abs(from_area * free - to_area * back);
        for (std::uint32_t k = 0; k <= random.below(3); ++k)
            c.blockers.push_back(random_polygon(random, 0.3, 0.5 * (c.from[0] + c.to[0]) + 0.2 * any()));
        const ExchangeEstimate e = factor(c, {}, tolerance * std::min(from_area, to_area));
        partial += e.nodes > 0 ? 1 : 0;
        const bool sound = free >= -1e-12 && free <= 1 + 1e-9 && reciprocal <= 1e-12 * std::max(from_area, to_area) &&
                           e.value >= 0 && e.value <= free + 2 * tolerance;
        if (!sound && wrong++ < 5)
            ADD_FAILURE() << i << ": free " << free << ", back " << back << ", exact " << e.value << " ± " << e.error;
    });
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(partial, pairs / 20) << "too few of the pairs were partly hidden";
}

}  // namespace
}  // namespace patchlight
