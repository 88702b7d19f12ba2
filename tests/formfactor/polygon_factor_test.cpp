#include "formfactor/polygon_factor.h"

#include "formfactor/closed_form.h"
#include "formfactor/lambert.h"
#include "formfactor/random_numbers.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace patchlight {
namespace {

using Polygon = std::vector<Vec3>;
using std::numbers::pi;

Polygon floor_rectangle(double a, double b)
{
    return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
}

Polygon ceiling_rectangle(double a, double b, double d)
{
    return {{0, 0, d}, {0, b, d}, {a, b, d}, {a, 0, d}};
}

/// l × h, on the floor's edge x = 0, its face toward the floor's, `angle` between both.
Polygon hinged(double l, double h, double angle)
{
    const double x = h * std::cos(angle), z = h * std::sin(angle);
    return {{0, 0, 0}, {0, l, 0}, {x, l, z}, {x, 0, z}};
}

struct Row {
    std::string name;
    Polygon from, to;
    double factor, tolerance;
};

/// reference-values.md §1: every row with two polygons. The hinged ones are printed there with 14 digits.
std::vector<Row> reference_rows()
{
    const Polygon unit = floor_rectangle(1, 1);
    return {{"opposed d=1", unit, ceiling_rectangle(1, 1, 1), 0.19982489569838738304, 1e-14},
            {"opposed d=.1", unit, ceiling_rectangle(1, 1, 0.1), 0.82699452239725657792, 1e-14},
            {"opposed d=.5", unit, ceiling_rectangle(1, 1, 0.5), 0.41525328357714673537, 1e-14},
            {"opposed d=2", unit, ceiling_rectangle(1, 1, 2), 0.068589588818552447785, 1e-14},
            {"opposed d=10", unit, ceiling_rectangle(1, 1, 10), 0.0031620568387576016251, 1e-14},
            {"opposed 2x1", floor_rectangle(2, 1), ceiling_rectangle(2, 1, 1), 0.28587538485071471830, 1e-14},
            {"opposed 3x2", floor_rectangle(3, 2), ceiling_rectangle(3, 2, 1), 0.47557643653295291991, 1e-14},
            {"90°", unit, hinged(1, 1, pi / 2), 0.20004377607540315424, 1e-14},
            {"45°", unit, hinged(1, 1, pi / 4), 0.48334769547888, 2e-14},
            {"60°", unit, hinged(1, 1, pi / 3), 0.37090532115005, 2e-14},
            {"135°", unit, hinged(1, 1, 3 * pi / 4), 0.048309447801818, 2e-14},
            {"l=1 w=1 h=2", unit, hinged(1, 2, pi / 2), 0.23285260279536188805, 1e-14},
            {"reverse", hinged(1, 2, pi / 2), unit, 0.11642630139768094403, 1e-14},
            {"l=1 w=1 h=.5", unit, hinged(1, 0.5, pi / 2), 0.14618667910571331616, 1e-14}};
}

class Placement {
public:
    explicit Placement(RandomNumbers& random)
        : turn_(glm::normalize(glm::dquat(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5,
                                          random.uniform() - 0.5))),
          shift_(10 * random.uniform() - 5, 10 * random.uniform() - 5, 10 * random.uniform() - 5),
          scale_(std::pow(10, 6 * random.uniform() - 3))
    {}
    Polygon operator()(Polygon polygon) const
    {
        for (Vec3& p : polygon) p = scale_ * (turn_ * p + shift_);
        return polygon;
    }

private:
    glm::dquat turn_;
    Vec3 shift_;
    double scale_;
};

/// 3 to 6 vertices on an ellipse, anywhere in the unit cube: near pairs, far ones and such that cross each other.
Polygon random_polygon(RandomNumbers& random)
{
    const glm::dquat turn = glm::normalize(
        glm::dquat(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5));
    const Vec3 centre(random.uniform(), random.uniform(), random.uniform());
    const double a = 0.02 + 0.5 * random.uniform(), b = 0.02 + 0.5 * random.uniform();
    const auto count = 3 + random.below(4);
    Polygon polygon;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * pi * (i + 0.8 * random.uniform()) / count;
        polygon.push_back(centre + turn * Vec3(a * std::cos(angle), b * std::sin(angle), 0));
    }
    return polygon;
}

double area(const Polygon& polygon)
{
    Vec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    return 0.5 * glm::length(sum);
}

/// Lambert's formula on the midpoints of n × n pieces of the unit square.
double by_lambert(const Polygon& to, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) sum += lambert_factor({(i + 0.5) / n, (j + 0.5) / n, 0}, {0, 0, 1}, to);
    return sum / (n * n);
}

TEST(PolygonFactor, ReferenceRows)
{
    for (const Row& row : reference_rows())
        EXPECT_NEAR(polygon_factor(row.from, row.to), row.factor, row.tolerance) << row.name;
}

TEST(PolygonFactor, ReferenceRowsAnywhereTurnedAndScaled)
{
    RandomNumbers random(1, 1);
    for (const Row& row : reference_rows())
        for (int i = 0; i < 100; ++i) {
            const Placement place(random);
            // The coordinates themselves are rounded to 1e-15 of the distance from the origin.
            EXPECT_NEAR(polygon_factor(place(row.from), place(row.to)), row.factor, 1e-12) << row.name;
        }
}

// A row of a box sums to 1: one opposed face and four that share an edge.
TEST(PolygonFactor, CubeCloses)
{
    RandomNumbers random(2, 1);
    const Placement place(random);
    const Polygon from = place(floor_rectangle(1, 1));
    double row = polygon_factor(from, place(ceiling_rectangle(1, 1, 1)));
    row += polygon_factor(from, place({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}));
    row += polygon_factor(from, place({{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}));
    row += polygon_factor(from, place({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}));
    row += polygon_factor(from, place({{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}));
    EXPECT_NEAR(row, 1, 1e-13);
}

TEST(PolygonFactor, RandomPairsAreFractionsAndReciprocal)
{
    RandomNumbers random(3, 1);
    int facing = 0;
    for (int i = 0; i < 10000; ++i) {
        const Polygon a = random_polygon(random), b = random_polygon(random);
        const double ab = polygon_factor(a, b), ba = polygon_factor(b, a);
        ASSERT_TRUE(ab >= 0 && ab <= 1 && ba >= 0 && ba <= 1) << i << ": " << ab << " " << ba;
        ASSERT_NEAR(area(a) * ab, area(b) * ba, 1e-14 * area(a) * ab) << i;
        ASSERT_EQ(polygon_exchange(a, b), polygon_exchange(b, a)) << i;
        if (ab > 0) ++facing;
    }
    // A quarter of random pairs face each other, and more see each other in part.
    EXPECT_GT(facing, 2500);
}

// Turning changes the order in which the contours are taken, so which of both integrals is done by quadrature.
TEST(PolygonFactor, RandomPairsAnywhereTurnedAndScaled)
{
    RandomNumbers random(4, 1);
    for (int i = 0; i < 3000; ++i) {
        const Polygon a = random_polygon(random), b = random_polygon(random);
        const Placement place(random);
        EXPECT_NEAR(polygon_factor(a, b), polygon_factor(place(a), place(b)), 1e-10) << i;
    }
}

// Beside the contour integral, an integral of another kind. The midpoint rule's error falls like n⁻², so two of them
// give the limit: 1e-6 is left where nothing is nearer than 0.3.
TEST(PolygonFactor, AgreesWithLambertsFormulaOverTheArea)
{
    RandomNumbers random(5, 1);
    for (int i = 0; i < 20; ++i) {
        Polygon to = random_polygon(random);
        double lowest = 1e300;
        for (const Vec3& p : to) lowest = std::min(lowest, p.z);
        const double lift = 0.3 + random.uniform() - lowest;
        for (Vec3& p : to) p.z += lift;
        if (glm::cross(to[1] - to[0], to[2] - to[0]).z > 0) std::reverse(to.begin(), to.end());
        // Its plane may cut the square, where Lambert's factor has a kink: n⁻² with another constant.
        const double extrapolated = (4 * by_lambert(to, 128) - by_lambert(to, 64)) / 3;
        EXPECT_NEAR(polygon_factor(floor_rectangle(1, 1), to), extrapolated, 2e-6) << i;
    }
}

TEST(PolygonFactor, CuttingAPolygonChangesNothing)
{
    RandomNumbers random(6, 1);
    for (int i = 0; i < 1000; ++i) {
        const Polygon a = random_polygon(random), b = random_polygon(random);
        const Polygon corner{a[0], a[1], a[2]};
        double cut = polygon_exchange(corner, b);
        Polygon rest = a;
        rest.erase(rest.begin() + 1);
        if (rest.size() > 2) cut += polygon_exchange(rest, b);
        EXPECT_NEAR(cut, polygon_exchange(a, b), 1e-11 * std::min(area(a), area(b))) << i;
    }
}

// A wall along a part of the floor's edge and beyond the edge's end.
TEST(PolygonFactor, PartlySharedEdge)
{
    const Polygon ground = floor_rectangle(1, 1);
    const Polygon wall{{0, 0.4, 0}, {0, 1.7, 0}, {0, 1.7, 0.8}, {0, 0.4, 0.8}};
    const Polygon inside{{0, 0.4, 0}, {0, 1, 0}, {0, 1, 0.8}, {0, 0.4, 0.8}};
    const Polygon beyond{{0, 1, 0}, {0, 1.7, 0}, {0, 1.7, 0.8}, {0, 1, 0.8}};
    EXPECT_NEAR(polygon_factor(ground, wall), polygon_factor(ground, inside) + polygon_factor(ground, beyond), 1e-14);
    // Side by side along the edge's line: (whole 2l − 2 halves)/2 by reciprocity.
    const Polygon next{{0, 1, 0}, {0, 2, 0}, {0, 2, 1}, {0, 1, 1}};
    const double expected = (2 * perpendicular_rectangles(2, 1, 1) - 2 * perpendicular_rectangles(1, 1, 1)) / 2;
    EXPECT_NEAR(polygon_factor(ground, next), expected, 1e-14);
}

// Two squares on a hinge, each halved: some of the triangles share the hinge, others one of its ends, and all four
// pairs add up to the whole, nearly closed or nearly flat.
TEST(PolygonFactor, TrianglesThatShareAVertex)
{
    RandomNumbers random(7, 1);
    const double angles[] = {0.01, 0.3, pi / 2, 2.5, 3.1};
    for (const double angle : angles) {
        const Placement place(random);
        const Polygon leaf = hinged(1, 1, angle);
        double sum = 0;
        for (const Polygon& part : {Polygon{leaf[0], leaf[1], leaf[2]}, Polygon{leaf[0], leaf[2], leaf[3]}})
            for (const Polygon& half :
                 {Polygon{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Polygon{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}})
                sum += polygon_exchange(half, part);
        EXPECT_NEAR(sum, polygon_factor(floor_rectangle(1, 1), leaf), 1e-12) << angle;
        EXPECT_NEAR(polygon_factor(place(floor_rectangle(1, 1)), place(leaf)), sum, 1e-11) << angle;
    }
}

// Polygons that stand through each other's plane: what counts is the part in front.
TEST(PolygonFactor, IsClippedAtBothPlanes)
{
    const Polygon ground{{-1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 1, 0}};
    const Polygon wall{{0, 0, -3}, {0, 1, -3}, {0, 1, 1}, {0, 0, 1}};
    EXPECT_NEAR(polygon_factor(ground, wall), 0.5 * perpendicular_rectangles(1, 1, 1), 1e-14);
    EXPECT_NEAR(polygon_factor(wall, ground), 0.25 * perpendicular_rectangles(1, 1, 1), 1e-14);
}

TEST(PolygonFactor, WhatFacesAwayOrLiesInThePlaneGetsNothing)
{
    Polygon up = ceiling_rectangle(1, 1, 1);
    std::reverse(up.begin(), up.end());
    EXPECT_EQ(polygon_factor(floor_rectangle(1, 1), up), 0);
    EXPECT_EQ(polygon_factor(floor_rectangle(1, 1), ceiling_rectangle(1, 1, -1)), 0);
    Polygon beside = floor_rectangle(1, 1);
    for (Vec3& p : beside) p.x += 1;
    RandomNumbers random(8, 1);
    for (int i = 0; i < 100; ++i) {
        const Placement place(random);
        EXPECT_EQ(polygon_factor(place(floor_rectangle(1, 1)), place(beside)), 0);
        EXPECT_EQ(polygon_factor(place(floor_rectangle(1, 1)), place(floor_rectangle(1, 1))), 0);
    }
}

// Down to 1e-6 apart and up to 1e6: held against the closed form, which is good to its last digits there.
TEST(PolygonFactor, NearAndFarSquares)
{
    for (const double d : {1e-6, 1e-3, 1e-2}) {
        const double exact = parallel_rectangles(1, 1, d);
        EXPECT_NEAR(polygon_factor(floor_rectangle(1, 1), ceiling_rectangle(1, 1, d)), exact, 1e-13) << d;
    }
    for (const double d : {15.0, 22.0, 1e2, 1e4, 1e6}) {
        const double exact = parallel_rectangles(1, 1, d);
        EXPECT_NEAR(polygon_factor(floor_rectangle(1, 1), ceiling_rectangle(1, 1, d)), exact, 1e-11 * exact) << d;
    }
}

// A small square sees a large one as a point does, but for what the factor varies over it: size²/24 times second
// derivatives of about 1, less on the 1e-4 and 1e-6 squares than 1e-8 and 1e-12.
TEST(PolygonFactor, SmallBesideLarge)
{
    const Polygon ceiling = ceiling_rectangle(1, 1, 1);
    for (const double size : {1e-4, 1e-6}) {
        const double low = 0.5 - size / 2, high = 0.5 + size / 2;
        const Polygon small{{low, low, 0}, {high, low, 0}, {high, high, 0}, {low, high, 0}};
        // The corners' coordinates are rounded: 1e-16/size of the area.
        EXPECT_NEAR(polygon_factor(small, ceiling), 0.23945647046077353883, size * size + 1e-15 / size) << size;
    }
}

TEST(PolygonFactor, TheToleranceBoundsTheError)
{
    RandomNumbers random(9, 1);
    for (int i = 0; i < 1000; ++i) {
        const Polygon a = random_polygon(random), b = random_polygon(random);
        const double fine = polygon_exchange(a, b, 1e-13), smaller = std::min(area(a), area(b));
        for (const double tolerance : {1e-3, 1e-6, 1e-9})
            ASSERT_NEAR(polygon_exchange(a, b, tolerance), fine, tolerance * smaller) << i << " " << tolerance;
    }
}

TEST(PolygonFactor, BadPolygonsAreNamed)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const Polygon good = floor_rectangle(1, 1);
    const auto complaint = [&](const Polygon& from, const Polygon& to) -> std::string {
        try {
            polygon_factor(from, to);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(complaint(good, {{0, 0, 1}, {1, 0, 1}}), "polygon_factor: the second polygon has fewer than 3 vertices");
    EXPECT_EQ(complaint({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, good), "polygon_factor: the first polygon has no area");
    EXPECT_EQ(complaint(good, {{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}), "polygon_factor: the second polygon has no area");
    EXPECT_EQ(complaint(good, {{0, 0, 1}, {1, 0, nan}, {2, 1, 1}}),
              "polygon_factor: the second polygon has a vertex that is not finite");
    EXPECT_EQ(complaint({{0, 0, 1}, {1, -inf, 1}, {2, 1, 1}}, good),
              "polygon_factor: the first polygon has a vertex that is not finite");
    EXPECT_EQ(complaint(good, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1.01}, {0, 1, 1}}),
              "polygon_factor: the second polygon is not planar");
    EXPECT_EQ(complaint(good, {{0, 0, 1}, {2, 0, 1}, {0.5, 0.5, 1}, {0, 2, 1}}),
              "polygon_factor: the second polygon is not convex");
    Polygon star;  // turns left everywhere, twice around
    for (int i = 0; i < 5; ++i) star.push_back({std::cos(0.8 * pi * i), std::sin(0.8 * pi * i), 1});
    EXPECT_EQ(complaint(star, good), "polygon_factor: the first polygon is not convex");
    EXPECT_THROW(polygon_factor(good, good, 0), std::invalid_argument);
    EXPECT_THROW(polygon_factor(good, good, nan), std::invalid_argument);
}

// Vertices on a straight edge and repeated ones are no fault.
TEST(PolygonFactor, CornersARoundingApartAreOneCorner)
{
    // What clipping left of a patch of the Cornell box: the last edge runs backwards.
    const Polygon doubled = {{0.015203677367485647, 0, 0.049644660791789877},
                             {0.02051850313246293, 0, 0.019697763007164373},
                             {6.3080853671883888e-17, 0, 8.4107804895845192e-17},
                             {4.2053902447922596e-17, 0, 5.2567378059903242e-17}};
    const Polygon clean(doubled.begin(), doubled.begin() + 3);
    const Polygon above = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
    EXPECT_NEAR(polygon_factor(doubled, above), polygon_factor(clean, above), 1e-14);
    EXPECT_GT(polygon_factor(clean, above), 0.1);
}

TEST(PolygonFactor, SuperfluousVerticesChangeNothing)
{
    const Polygon rich{{0, 0, 0}, {0.3, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0.6, 0}};
    EXPECT_NEAR(polygon_factor(rich, hinged(1, 1, pi / 2)), perpendicular_rectangles(1, 1, 1), 1e-14);
}

}  // namespace
}  // namespace patchlight
