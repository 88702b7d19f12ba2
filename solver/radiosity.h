#pragma once

#include "meshing/fields.h"

namespace patchlight {

/// B in W/m² for each patch, three bands. B ≥ E ≥ 0.
using Radiosity = PatchField<Rgb>;

/// B in W/m² at each vertex, three bands: the linear reconstruction. Vertices belong to one surface, so light
/// may jump between surfaces.
using VertexRadiosity = VertexField<Rgb>;

}  // namespace patchlight
