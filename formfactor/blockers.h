#pragma once

#include "formfactor/facets.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// A convex polygon that may stand in the way; its winding and side don't matter.
struct Blocker {
    std::vector<Vec3> corners;
    Vec3 normal{0.0};   ///< unit
    double offset = 0;  ///< dot(normal, corner)
};

/// What lies between two convex polygons of different planes.
enum class Visibility {
    visible,  ///< nothing stands in between
    hidden,   ///< no segment between them is free, or one is behind the other's plane
    partial   ///< cannot tell more
};

/// The scene's surfaces as blockers, found by the volume of the shaft between two polygons, never by sample rays:
/// conservative, none is missed.
class Blockers {
public:
    explicit Blockers(const Scene& scene);
    /// Of polygons given directly (tests, programs without a scene). `size`: the extent of everything, m.
    Blockers(std::vector<Blocker> blockers, double size);

    /// Collects into `found` what may stand in the shaft between two convex polygons: each blocker clipped to what is
    /// in front of both planes. Visibility is `visible` only if `found` is empty.
    Visibility between(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b, const Vec3& normal_b,
                       std::vector<Blocker>& found) const;

    std::span<const Blocker> all() const { return blockers_; }
    /// Lengths below are nothing: what rounding leaves of coordinates, m.
    double snap() const { return snap_; }

private:
    std::vector<Blocker> blockers_;
    double snap_ = 0;
};

}  // namespace patchlight
