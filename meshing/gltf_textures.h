#pragma once

#include "meshing/gltf_file.h"
#include "meshing/vectors.h"

#include <optional>
#include <string>

namespace patchlight {

/// The mean colour, linear Rec. 709, of the image that a texture shows; nothing, and the reason in `why`, when
/// it can't be had: outside the scene's folder, missing, larger than 8192 × 8192, no PNG or JPEG.
std::optional<Rgb> mean_texture_colour(const GltfFile& gltf, int texture, std::string& why);

}  // namespace patchlight
