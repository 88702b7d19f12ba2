#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/run/stored_solution.h"

#include <string>

namespace patchlight {

/// A mesh of another run to solve on, and what names it in the record.
struct GivenMesh {
    PatchMeshArrays arrays;
    std::string sha256;  ///< of the solution that holds it
};

/// The last mesh of a run, for a scene of the same surfaces: what they are made of may differ. Throws UsageError
/// ("mesh") where surfaces differ, FolderRefused for what isn't a run, SceneError for a broken one.
GivenMesh mesh_of_run(const std::string& run, const Scene& scene);

/// The last solution of a run, for a scene of the same surfaces and materials. Throws as mesh_of_run, UsageError
/// ("reference") where materials differ.
StoredSolution solution_lit_alike(const std::string& run, const Scene& scene);

}  // namespace patchlight
