#pragma once

#include "formfactor/facet_tree.h"

#include <array>
#include <span>
#include <vector>

namespace patchlight {

/// How a point lies on the outline of what stands around it.
enum class Outline {
    hidden,    ///< not: rays past it meet something however they are shifted a little sideways
    straight,  ///< on a straight piece of it
    corner
};

/// The facets around a point: those that have it as a corner, on their rim or inside.
struct CornerFan {
    std::vector<std::array<Vec3, 2>> sectors;  ///< directions from the point, less than 180° apart
    std::vector<Vec3> normals;                 ///< of the facets

    /// Of what stands around the point, seen along d. A corner also where nothing of it is seen but edge on.
    Outline outline(const Vec3& d) const;
};

/// Heights and distances up to `snap` (m) are nothing.
CornerFan corner_fan(const FacetTree& tree, std::span<const Facet> facets, const Vec3& point, double snap);

}  // namespace patchlight
