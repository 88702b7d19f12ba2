#pragma once

#include "formfactor/convex_polygon.h"
#include "formfactor/facets.h"
#include "formfactor/shaft.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace patchlight {

/// A convex polygon that may stand in the way, from both sides.
struct Blocker {
    Polygon corners;          ///< counter-clockwise seen against the normal
    Vec3 normal{0.0};         ///< unit
    double offset = 0;        ///< dot(normal, corner)
    std::uint32_t index = 0;  ///< in Blockers::all(), also of what is left after clipping

    BlockerView view() const { return {corners, normal, offset}; }
};

/// The scene's surfaces as blockers, found by the volume of the shaft between two polygons, never by sample rays:
/// conservative, none is missed. All queries may be made from many threads at once.
class Blockers {
public:
    /// All surfaces; of two back to back only one. What protrudes in front of a polygon's plane by less than 1e-8 of
    /// the scene's diameter is in the plane, as everywhere on the snapped geometry.
    explicit Blockers(const Scene& scene);
    /// Of polygons given directly (tests, programs without a scene). `size`: the extent of everything, m.
    Blockers(std::vector<Blocker> blockers, double size);
    Blockers(Blockers&&) noexcept;
    Blockers& operator=(Blockers&&) noexcept;
    ~Blockers();

    /// Collects into `found` what may stand in the shaft between two convex polygons: each blocker clipped to what is
    /// in front of both planes. `visible` when there is none; `hidden` when one covers all (it is the last in
    /// `found`), or when a polygon is behind the other's plane or in it.
    Visibility between(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b, const Vec3& normal_b,
                       std::vector<Blocker>& found) const;
    /// The same, but not tried when the boxes of more than `most` blockers meet the shaft's: `partial` then.
    Visibility among_few(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b, const Vec3& normal_b,
                         std::size_t most, std::vector<Blocker>& found) const;

    std::span<const Blocker> all() const { return blockers_; }
    /// Heights below are nothing, m.
    double snap() const { return snap_; }

private:
    struct Tree;
    std::vector<Blocker> blockers_;
    std::unique_ptr<Tree> tree_;
    double snap_ = 0;
};

/// The same over blockers that are already clipped to the front of both planes: the indices of those in the shaft.
Visibility sift(const Shaft& shaft, std::span<const Blocker> candidates, double snap,
                std::vector<std::uint32_t>& found);

}  // namespace patchlight
