#pragma once

#include "formfactor/facets.h"

#include <cstddef>
#include <span>
#include <vector>

namespace patchlight {

/// A point on one of several facets.
struct FacetPoint {
    Vec3 position{0.0};
    std::size_t facet = 0;
};

/// Maps the unit square to facets so that equal areas go to equal areas, all facets together: uniform points of the
/// square become points uniform over the facets' area, strata become strata.
class FacetPoints {
public:
    /// Throws std::invalid_argument when the facets have no area.
    explicit FacetPoints(std::span<const Facet> facets);
    /// On one convex polygon.
    explicit FacetPoints(std::span<const Vec3> polygon);

    /// u, v in (0, 1).
    FacetPoint at(double u, double v) const;
    double area() const { return area_; }

private:
    /// A triangle or a parallelogram.
    struct Piece {
        Vec3 corner, edge0, edge1;
        double until = 0;  ///< share of the area up to and with this piece
        std::size_t facet = 0;
        bool parallelogram = false;
    };
    void add(std::span<const Vec3> polygon, std::size_t index);
    void divide();

    std::vector<Piece> pieces_;
    double area_ = 0;
};

}  // namespace patchlight
