#pragma once

#include "formfactor/facets.h"
#include "tests/verification/rectangle_light.h"

#include <algorithm>
#include <span>
#include <vector>

namespace patchlight::testing {

/// Direct factors by brute force: every convex facet of the scene cuts the light, nothing is searched or left out but
/// what doesn't protrude from the plane of the receiver or the light by more than the snapping distance. Shares the
/// cut into facets with the library, no geometry of light.
class BruteForceLight {
public:
    BruteForceLight(const Scene& scene, SurfaceId receiver, SurfaceId source)
        : normal_(scene.surface(receiver).frame.n), snap_(1e-8 * scene.diameter)
    {
        const std::vector<Facet> all = facets_of(scene);
        const Vec3 origin = scene.surface(receiver).frame.origin;
        for (const Facet& facet : all) {
            if (facet.surface != source) continue;
            Light& light = lights_.emplace_back(Light{facet, {}});
            for (const Facet& other : all)
                if (protrudes(other, normal_, origin) && protrudes(other, facet.normal, facet.corners[0]))
                    light.blockers.push_back(flattened(other));
        }
    }

    double factor(const Vec3& x) const
    {
        double sum = 0;
        for (const Light& light : lights_) {
            const bool sees = glm::dot(light.facet.normal, x - light.facet.corners[0]) > snap_ &&
                              std::ranges::any_of(light.facet.corners,
                                                  [&](const Vec3& p) { return glm::dot(normal_, p - x) > snap_; });
            if (sees) sum += reference::lit_factor(x, normal_, light.facet.corners, light.blockers);
        }
        return sum;
    }

private:
    struct Light {
        Facet facet;
        std::vector<reference::Loop> blockers;
    };

    /// Facets of snapped surfaces are bent by up to the snapping distance: which of two planes an end of a light is cut
    /// at must not be left to the first three corners.
    static reference::Loop flattened(const Facet& facet)
    {
        reference::Loop loop = facet.corners;
        for (Vec3& p : loop) p -= glm::dot(facet.normal, p - loop[0]) * facet.normal;
        return loop;
    }

    bool protrudes(const Facet& facet, const Vec3& n, const Vec3& origin) const
    {
        return std::ranges::any_of(facet.corners, [&](const Vec3& p) { return glm::dot(n, p - origin) > snap_; });
    }

    Vec3 normal_;
    double snap_;
    std::vector<Light> lights_;
};

}  // namespace patchlight::testing
