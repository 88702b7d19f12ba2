#pragma once

#include "meshing/fields.h"

#include <array>

namespace patchlight {

/// B in W/m² for each patch, three bands. B ≥ E ≥ 0.
using Radiosity = PatchField<Rgb>;

/// B in W/m² at each vertex, three bands: the linear reconstruction. Vertices belong to one surface, so light
/// may jump between surfaces.
using VertexRadiosity = VertexField<Rgb>;

/// B in W/m² at the middle of each patch's edges, from corner k to k + 1: what quadratic elements have besides.
/// Two patches have the same value at their common edge, except across a contact line.
using MidpointRadiosity = PatchField<std::array<Rgb, 3>>;

/// B on quadratic elements.
struct QuadraticRadiosity {
    VertexRadiosity at_vertices;
    MidpointRadiosity at_middles;
};

enum class Elements {
    linear,    ///< nodes at the vertices
    quadratic  ///< and at the middles of edges
};

}  // namespace patchlight
