#pragma once

#include "meshing/scene.h"
#include "solver/adaptive.h"

#include <cstddef>
#include <string>

namespace patchlight {

/// What a solve will roughly need. Bytes are within 20 % where the rows or --vertex-rays decide them; the rest are
/// orders of magnitude.
struct CostEstimate {
    std::size_t elements = 0;  ///< of the largest mesh
    double rays = 0;           ///< of all cycles
    double bytes = 0;          ///< at the largest
    double cpu_seconds = 0;    ///< of all cycles and threads, without pictures
};

CostEstimate estimate_cost(const Scene& scene, const AdaptiveOptions& options);

/// The same; throws LimitError, with how many elements fit and what else to do, when a solve needs more than `limit`
/// bytes; 0: default_memory().
CostEstimate check_memory(const Scene& scene, const AdaptiveOptions& options, double limit = 0);

/// Triangles of the uniform mesh, roughly: those of `max_edge`, and no more than `max_elements`.
double uniform_elements(const Scene& scene, const MeshingOptions& meshing);

/// What meshing and holding so many elements takes, without factors.
double mesh_bytes(double elements);

/// Throws LimitError ("needs … GiB, limit … GiB (…); `instead`"). `limit` in bytes; 0: default_memory().
void require_memory(double needed, double limit, const std::string& instead);

}  // namespace patchlight
