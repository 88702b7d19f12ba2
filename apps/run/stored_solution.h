#pragma once

#include "meshing/patch_mesh.h"
#include "solver/radiosity.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace patchlight {

/// A solution as solution.glb keeps it: enough to render, probe, export, and to go on refining.
struct StoredSolution {
    Scene scene;
    PatchMesh mesh;
    Radiosity B;
    VertexRadiosity vertex_B;
    MidpointRadiosity middle_B;     ///< empty: linear elements
    PatchField<double> eta;         ///< W/m²·m, as in ErrorEstimate
    PatchField<std::uint8_t> edge;  ///< as in ErrorEstimate
};

/// A binary glTF 2.0 file. For viewers: POSITION relative to the scene's centre (which the node carries), one
/// primitive a material, unlit COLOR_0 = B/π scaled into [0, 1], float _RADIOSITY in W/m². For reading back:
/// doubles and ids in bufferViews whose numbers stand in `extras.patchlight.views`.
std::string encode_solution(const Scene& scene, const PatchMesh& mesh, const Radiosity& B,
                            const VertexRadiosity& vertex_B, const PatchField<double>& eta,
                            const PatchField<std::uint8_t>& edge, const MidpointRadiosity& middle_B = {});

/// Reads it back, equal to the bit. `name` is used in messages. Throws SceneError ("solution") for anything
/// that isn't a whole stored solution; opens no other file.
StoredSolution decode_solution(std::string_view bytes, const std::string& name);

/// The same from a file. Throws SceneError ("solution") also when it can't be opened.
StoredSolution read_solution(const std::filesystem::path& file);

}  // namespace patchlight
