#pragma once

#include "meshing/ids.h"
#include "meshing/scene.h"
#include "meshing/vectors.h"

#include <cstddef>
#include <vector>

namespace patchlight {

class DirectLight;

/// A surface that sends on much of the emitters' light: its shadows have lines, too.
struct SecondarySource {
    SurfaceId surface;
    Rgb exitance{0.0};  ///< mean over the surface, W/m²
};

/// The surfaces with the most unshot power once the emitters, and nobody else, have shot: the fewest that together hold
/// `share` of it, at most `most`, brightest first. ∫ρH dA by the middles of patches a twelfth of the scene wide.
std::vector<SecondarySource> secondary_sources(const Scene& scene, const DirectLight& direct, double share,
                                               std::size_t most);

}  // namespace patchlight
