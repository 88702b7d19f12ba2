#include "formfactor/reference_cases.h"

#include "formfactor/closed_form.h"
#include "formfactor/lambert.h"

#include <cmath>
#include <numbers>

namespace patchlight {

namespace {

using Polygon = ReferencePolygon;

/// Takes the place of infinity where a formula's limit goes with 1/length: off by less than 1e-13.
constexpr double very_long = 1e13;

Polygon rectangle(const Vec3& corner, const Vec3& u, const Vec3& v)
{
    return {corner, corner + u, corner + u + v, corner + v};
}

Polygon floor_of(double a, double b)
{
    return rectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0});
}

/// At height d, facing down.
Polygon ceiling_of(double a, double b, double d)
{
    return rectangle({0, 0, d}, {0, b, 0}, {a, 0, 0});
}

/// Hinged to the floor's edge y = 0, facing the floor.
Polygon flap(double l, double h, double degrees)
{
    const double angle = degrees * std::numbers::pi / 180;
    const double c = degrees == 90 ? 0 : std::cos(angle);
    return rectangle({0, 0, 0}, {0, h * c, h * std::sin(angle)}, {l, 0, 0});
}

ReferencePair opposed(const std::string& name, double a, double b, double d, double factor)
{
    return {
        name, d > 2 ? ReferenceKind::distant : ReferenceKind::facing, factor, {floor_of(a, b)}, {ceiling_of(a, b, d)},
        {}};
}

ReferencePair hinged(const std::string& name, double l, double w, double h, double degrees, double factor)
{
    return {name, ReferenceKind::touching, factor, {floor_of(l, w)}, {flap(l, h, degrees)}, {}};
}

ReferencePair reversed(const std::string& name, ReferencePair pair, double factor)
{
    std::swap(pair.from, pair.to);
    pair.name = name;
    pair.factor = factor;
    return pair;
}

/// From the floor of the unit cube to its other five sides, which see nothing but each other: 1.
ReferencePair cube_floor()
{
    const Polygon ceiling = ceiling_of(1, 1, 1);
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    return {"cube, floor to the rest",
            ReferenceKind::touching,
            1,
            {floor_of(1, 1)},
            {ceiling, rectangle({0, 0, 0}, y, z), rectangle(x, z, y), rectangle({0, 0, 0}, z, x), rectangle(y, x, z)},
            {}};
}

ReferencePair blocked(const std::string& name, double factor, std::vector<Polygon> blockers,
                      ReferenceKind kind = ReferenceKind::occluded)
{
    return {name, kind, factor, {floor_of(1, 1)}, {ceiling_of(1, 1, 1)}, std::move(blockers)};
}

Polygon blocker(double x0, double y0, double x1, double y1, double z)
{
    return rectangle({x0, y0, z}, {x1 - x0, 0, 0}, {0, y1 - y0, 0});
}

/// All light between two disjoint caps of a sphere passes the discs at their rims: A_cap1 F = A_disc1 F_discs. The caps
/// are the parts within the angles `one` and `other` of opposite poles.
double between_caps(double one, double other)
{
    const double r1 = std::sin(one), r2 = std::sin(other), h = std::cos(one) + std::cos(other);
    const double cap = 2 * std::numbers::pi * (1 - std::cos(one));
    return std::numbers::pi * r1 * r1 * coaxial_discs(r1, r2, h) / cap;
}

/// From a small area on the floor, x away from a wall of height 1 that goes on to both sides.
double beside_a_wall(double x)
{
    const double half = 1e8;
    return lambert_factor({0, x, 0}, {0, 0, 1}, rectangle({-half, 0, 0}, {0, 0, 1}, {2 * half, 0, 0}));
}

void add_rectangle_formulas(std::vector<ReferenceFormula>& list)
{
    const auto parallel = [&](const char* name, double a, double b, double c, double factor) {
        list.push_back({name, factor, "C-11", [=] { return parallel_rectangles(a, b, c); }});
    };
    const auto perpendicular = [&](const char* name, double l, double w, double h, double factor) {
        list.push_back({name, factor, "C-14", [=] { return perpendicular_rectangles(l, w, h); }});
    };
    parallel("opposed squares, d = 1", 1, 1, 1, 0.19982489569838738304);
    parallel("opposed squares, d = 0.1", 1, 1, 0.1, 0.82699452239725657792);
    parallel("opposed squares, d = 0.5", 1, 1, 0.5, 0.41525328357714673537);
    parallel("opposed squares, d = 2", 1, 1, 2, 0.068589588818552447785);
    parallel("opposed squares, d = 10", 1, 1, 10, 0.0031620568387576016251);
    parallel("opposed 2 x 1, d = 1", 2, 1, 1, 0.28587538485071471830);
    parallel("opposed 3 x 2, d = 1", 3, 2, 1, 0.47557643653295291991);
    perpendicular("squares sharing an edge, 90 deg", 1, 1, 1, 0.20004377607540315424);
    perpendicular("perpendicular, l = 1, w = 1, h = 2", 1, 1, 2, 0.23285260279536188805);
    perpendicular("perpendicular, l = 1, w = 2, h = 1", 1, 2, 1, 0.11642630139768094403);
    perpendicular("perpendicular, l = 1, w = 1, h = 0.5", 1, 1, 0.5, 0.14618667910571331616);
    list.push_back({"cube, opposite and 4 adjacent", 1, "C-11, C-14",
                    [] { return parallel_rectangles(1, 1, 1) + 4 * perpendicular_rectangles(1, 1, 1); }});
}

void add_curved_formulas(std::vector<ReferenceFormula>& list)
{
    const auto discs = [&](const char* name, double r1, double r2, double h, double factor) {
        list.push_back({name, factor, "C-41", [=] { return coaxial_discs(r1, r2, h); }});
    };
    discs("coaxial discs, r = 1, 1, h = 1", 1, 1, 1, 0.38196601125010515180);
    discs("coaxial discs, r = 1, 1, h = 2", 1, 1, 2, 0.17157287525380990240);
    discs("coaxial discs, r = 1, 2, h = 1", 1, 2, 1, 0.76393202250021030359);
    discs("coaxial discs, r = 2, 1, h = 1", 2, 1, 1, 0.19098300562505257590);
    const double sixty = std::numbers::pi / 3, forty = 2 * std::numbers::pi / 9;
    // A_j / A_total of a cap within 60° is (1 − cos 60°)/2, of one within 40° (1 − cos 40°)/2.
    list.push_back({"sphere, cap of 40 to cap of 60 deg", 0.25, "C-41", [=] { return between_caps(forty, sixty); }});
    list.push_back({"sphere, cap of 60 to cap of 40 deg", 0.11697777844051098240, "C-41",
                    [=] { return between_caps(sixty, forty); }});
}

void add_small_area_formulas(std::vector<ReferenceFormula>& list)
{
    const auto below = [&](const char* name, double x, double y, double factor) {
        list.push_back({name, factor, "Lambert", [=] {
                            return lambert_factor({x, y, 0}, {0, 0, 1}, ceiling_of(1, 1, 1));
                        }});
    };
    below("small area below a square's centre, h = 1", 0.5, 0.5, 0.23945647046077353883);
    below("small area below a square's corner, h = 1", 0, 0, 0.13853160599489299678);
    const auto wall = [&](const char* name, double x, double factor) {
        list.push_back({name, factor, "Lambert", [=] { return beside_a_wall(x); }});
    };
    wall("small area beside a wall, x = 0.001", 0.001, 0.49950000024999981250);
    wall("small area beside a wall, x = 0.01", 0.01, 0.49500024998125156236);
    wall("small area beside a wall, x = 0.1", 0.1, 0.45024814048950054322);
    wall("small area beside a wall, x = 0.5", 0.5, 0.27639320225002103036);
    wall("small area beside a wall, x = 1", 1, 0.14644660940672623780);
    list.push_back({"long strips, perpendicular and equal", 0.29289321881345247560, "C-14",
                    [] { return perpendicular_rectangles(very_long, 1, 1); }});
    list.push_back({"long strips, parallel, w = h", 0.41421356237309504880, "C-11",
                    [] { return parallel_rectangles(1, very_long, 1); }});
}

}  // namespace

std::vector<ReferencePair> reference_pairs()
{
    const ReferencePair tall = hinged("perpendicular, l = 1, w = 1, h = 2", 1, 1, 2, 90, 0.23285260279536188805);
    return {
        opposed("opposed squares, d = 1", 1, 1, 1, 0.19982489569838738304),
        opposed("opposed squares, d = 0.1", 1, 1, 0.1, 0.82699452239725657792),
        opposed("opposed squares, d = 0.5", 1, 1, 0.5, 0.41525328357714673537),
        opposed("opposed squares, d = 2", 1, 1, 2, 0.068589588818552447785),
        opposed("opposed squares, d = 10", 1, 1, 10, 0.0031620568387576016251),
        opposed("opposed 2 x 1, d = 1", 2, 1, 1, 0.28587538485071471830),
        opposed("opposed 3 x 2, d = 1", 3, 2, 1, 0.47557643653295291991),
        hinged("squares sharing an edge, 90 deg", 1, 1, 1, 90, 0.20004377607540315424),
        hinged("squares sharing an edge, 45 deg", 1, 1, 1, 45, 0.48334769547888),
        hinged("squares sharing an edge, 60 deg", 1, 1, 1, 60, 0.37090532115005),
        hinged("squares sharing an edge, 135 deg", 1, 1, 1, 135, 0.048309447801818),
        tall,
        reversed("perpendicular, l = 1, w = 2, h = 1", tall, 0.11642630139768094403),
        hinged("perpendicular, l = 1, w = 1, h = 0.5", 1, 1, 0.5, 90, 0.14618667910571331616),
        cube_floor(),
        blocked("blocker [0,.5]x[0,.5] at z = .5", 0.149868671773790537, {blocker(0, 0, 0.5, 0.5, 0.5)}),
        blocked("blocker [.25,.75]x[.25,.75] at z = .25", 0.115620602132415, {blocker(0.25, 0.25, 0.75, 0.75, 0.25)}),
        blocked("blocker [0,.5]x[0,1] at z = .5", 0.0999124478491936915, {blocker(0, 0, 0.5, 1, 0.5)}),
        blocked("slit of 0.001 at z = .5", 0.001, {blocker(0, 0, 0.4995, 1, 0.5), blocker(0.5005, 0, 1, 1, 0.5)},
                ReferenceKind::sliver)};
}

std::vector<ReferenceFormula> reference_formulas()
{
    std::vector<ReferenceFormula> list;
    add_rectangle_formulas(list);
    add_curved_formulas(list);
    add_small_area_formulas(list);
    return list;
}

}  // namespace patchlight
