#pragma once

#include "formfactor/facet_tree.h"

#include <array>
#include <span>
#include <vector>

namespace patchlight {

/// The facets around a point: those that have it as a corner, on their rim or inside.
struct CornerFan {
    std::vector<std::array<Vec3, 2>> sectors;  ///< directions from the point, less than 180° apart
    std::vector<Vec3> normals;                 ///< of the facets

    /// Whether what stands around the point, seen along d, has a corner there. Not so where it hides all around, leaves a
    /// straight edge, or nothing of it is seen but edge on.
    bool has_corner(const Vec3& d) const;
};

/// Heights and distances up to `snap` (m) are nothing.
CornerFan corner_fan(const FacetTree& tree, std::span<const Facet> facets, const Vec3& point, double snap);

}  // namespace patchlight
