#include "apps/patchlight/given_mesh.h"

#include "apps/patchlight/usage_error.h"
#include "apps/run/sha256.h"
#include "apps/run/stored_solution.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

bool alike(const Surface& a, const Surface& b)
{
    return a.loops == b.loops && a.frame.n == b.frame.n && a.frame.origin == b.frame.origin && a.frame.u == b.frame.u;
}

}  // namespace

GivenMesh mesh_of_run(const std::string& run, const Scene& scene)
{
    const OpenedRun opened = open_run(run);
    const StoredSolution stored = solution_of(opened, {});
    const auto& theirs = stored.scene.surfaces;
    if (theirs.size() != scene.surfaces.size()) {
        throw UsageError("mesh", fmt::format("--mesh: {} has {} surfaces and the scene {}; give the run's own scene",
                                             run, theirs.size(), scene.surfaces.size()));
    }
    for (std::size_t s = 0; s < theirs.size(); ++s) {
        if (stored.scene.vertices != scene.vertices || !alike(theirs[s], scene.surfaces[s])) {
            throw UsageError("mesh",
                             fmt::format("--mesh: surface {} of {} is not the scene's; give the run's own scene "
                                         "and unit, only materials may differ",
                                         s, run));
        }
    }
    return {stored.mesh.arrays(), sha256_hex(encode_solution(stored.scene, stored.mesh, stored.B, stored.vertex_B,
                                                             stored.eta, stored.edge, stored.middle_B))};
}

}  // namespace patchlight
