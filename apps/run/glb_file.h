#pragma once

#include "apps/run/byte_views.h"
#include "meshing/patch_mesh.h"
#include "solver/radiosity.h"

#include <string>
#include <string_view>

namespace patchlight {

/// A GLB that viewers can show, with `views` beside it as bufferViews named in extras.
std::string encode_glb(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B,
                       const ByteViews& views);

/// The named arrays of a GLB that encode_glb made. Opens no other file. Throws SceneError ("solution").
ByteViews decode_glb(std::string_view bytes);

}  // namespace patchlight
