#pragma once

#include "solver/adaptive_options.h"
#include "solver/system.h"

#include <span>

namespace patchlight {

// What may have been made in Python, or doesn't belong together: all throw std::invalid_argument that says what it is.

/// Each names a surface of the scene, and is finite.
void check_lines(const Scene& scene, std::span<const SurfaceLine> lines);
/// The same, and each bisection an edge of the mesh's patches, no patch twice.
void check_plan(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan);
/// What ranges of single options don't tell.
void check_options(const Scene& scene, const AdaptiveOptions& options);
/// A mesh over the surfaces of such a scene, by their number.
void check_mesh(const Scene& scene, const PatchMesh& mesh);
/// One value a patch and a vertex of the mesh.
void check_estimate(const PatchMesh& mesh, const ErrorEstimate& error);
/// The equations of the exchange's patches.
void check_system(const Exchange& exchange, const RadiositySystem& system);
/// Rows that would take more than default_memory() are Python's MemoryError, with what to do instead.
void check_memory(const Exchange& exchange, const AdaptiveOptions& options);

}  // namespace patchlight
