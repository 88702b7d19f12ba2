#pragma once

#include "meshing/patch_mesh.h"
#include "solver/radiosity.h"

#include <filesystem>
#include <string>
#include <vector>

namespace patchlight {

/// The progressive solution after so many shots.
struct StoredSnapshot {
    int shots = 0;
    VertexRadiosity vertex_B;
};

/// "shots-03.glb".
std::string snapshot_file(int shots);

/// A GLB for viewers, with the doubles beside it: of the run's last mesh, whose solution.glb tells the rest.
std::string encode_snapshot(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B);

/// All snapshots in a run's folder, by the number of shots. Throws SceneError ("solution") when one can't be read or
/// hasn't a value for each vertex.
std::vector<StoredSnapshot> read_snapshots(const std::filesystem::path& folder, std::size_t vertices);

}  // namespace patchlight
