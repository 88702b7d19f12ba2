#pragma once

#include "formfactor/facets.h"
#include "formfactor/ray_caster.h"
#include "tests/formfactor/boxes.h"

#include <glm/common.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

/// Pairs of polygons whose form factors are known (reference-values.md §1, §2).
namespace patchlight::testing {

using Corners = std::vector<Vec3>;

struct KnownPair {
    std::string name;
    Corners from, to;
    std::vector<Corners> blockers;
    double factor = 0;
};

/// Surface 0 is `from`, 1 is `to`, the others block; with the caster and facets that go with it.
struct PairScene {
    explicit PairScene(const KnownPair& pair) : scene(scene_of(pair)), caster(scene)
    {
        from = facets_of(scene, SurfaceId(std::size_t{0}));
        to = facets_of(scene, SurfaceId(std::size_t{1}));
    }
    static Scene scene_of(const KnownPair& pair)
    {
        Scene result;
        result.objects = {"pair"};
        result.materials = {Material{}};
        add_surface(result, pair.from, 0);
        add_surface(result, pair.to, 0);
        for (const Corners& blocker : pair.blockers) add_surface(result, blocker, 0);
        Vec3 least = result.vertices[0], most = least;
        for (const Vec3& p : result.vertices) {
            least = glm::min(least, p);
            most = glm::max(most, p);
        }
        result.diameter = glm::length(most - least);
        return result;
    }

    Scene scene;
    RayCaster caster;
    std::vector<Facet> from, to;
};

/// [0, x] × [0, y] at height z, seen from above.
inline Corners floor_of(double x, double y, double z = 0)
{
    return {{0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}};
}

/// The same seen from below.
inline Corners ceiling_of(double x, double y, double z)
{
    return {{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}};
}

/// A rectangle that leaves the floor at its edge x = 0, 0 ≤ y ≤ l, and makes the given angle with it.
inline Corners wall_of(double l, double height, double degrees)
{
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 up = height * Vec3(std::cos(angle), 0, std::sin(angle)), along(0, l, 0);
    return {Vec3(0.0), along, along + up, up};
}

inline KnownPair opposed(double x, double y, double d, double factor)
{
    return {"opposed " + std::to_string(x) + " by " + std::to_string(y) + " at " + std::to_string(d),
            floor_of(x, y),
            ceiling_of(x, y, d),
            {},
            factor};
}

inline KnownPair hinged(double w, double h, double degrees, double factor)
{
    return {"hinged " + std::to_string(w) + " to " + std::to_string(h) + " at " + std::to_string(degrees),
            floor_of(w, 1),
            wall_of(1, h, degrees),
            {},
            factor};
}

/// Facing each other, no further than twice their size.
inline std::vector<KnownPair> facing_pairs()
{
    return {opposed(1, 1, 0.1, 0.82699452239725657792), opposed(1, 1, 0.5, 0.41525328357714673537),
            opposed(1, 1, 1, 0.19982489569838738304),   opposed(1, 1, 2, 0.068589588818552447785),
            opposed(2, 1, 1, 0.28587538485071471830),   opposed(3, 2, 1, 0.47557643653295291991)};
}

inline KnownPair far_pair()
{
    return opposed(1, 1, 10, 0.0031620568387576016251);
}

/// With an edge in common.
inline std::vector<KnownPair> hinged_pairs()
{
    return {hinged(1, 1, 90, 0.20004377607540315424),  hinged(1, 1, 45, 0.48334769547888),
            hinged(1, 1, 60, 0.37090532115005),        hinged(1, 1, 135, 0.048309447801818),
            hinged(1, 2, 90, 0.23285260279536188805),  hinged(2, 1, 90, 0.11642630139768094403),
            hinged(1, 0.5, 90, 0.14618667910571331616)};
}

/// Unit squares at z = 0 and 1, a thin blocker between them.
inline std::vector<KnownPair> blocked_pairs()
{
    const auto blocked = [](const std::string& name, double x0, double x1, double y0, double y1, double z,
                            double factor) {
        return KnownPair{
            name, floor_of(1, 1), ceiling_of(1, 1, 1), {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}}, factor};
    };
    return {blocked("a quarter at the middle", 0, 0.5, 0, 0.5, 0.5, 0.149868671773790537),
            blocked("a square in the middle, near", 0.25, 0.75, 0.25, 0.75, 0.25, 0.115620602132415),
            blocked("a half at the middle", 0, 0.5, 0, 1, 0.5, 0.0999124478491936915)};
}

}  // namespace patchlight::testing
