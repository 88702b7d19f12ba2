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

/// The last solution of a run of the scene's surfaces; `code` and `asked` are of the error's message.
StoredSolution solution_of_surfaces(const std::string& run, const Scene& scene, const char* code, const char* asked)
{
    StoredSolution stored = solution_of(open_run(run), {});
    const auto& theirs = stored.scene.surfaces;
    if (theirs.size() != scene.surfaces.size()) {
        throw UsageError(code, fmt::format("{}: {} has {} surfaces and the scene {}; give the run's own scene", asked,
                                           run, theirs.size(), scene.surfaces.size()));
    }
    for (std::size_t s = 0; s < theirs.size(); ++s) {
        if (stored.scene.vertices != scene.vertices || !alike(theirs[s], scene.surfaces[s])) {
            throw UsageError(code, fmt::format("{}: surface {} of {} is not the scene's; give the run's own scene "
                                               "and unit, only materials may differ",
                                               asked, s, run));
        }
    }
    return stored;
}

}  // namespace

GivenMesh mesh_of_run(const std::string& run, const Scene& scene)
{
    const StoredSolution stored = solution_of_surfaces(run, scene, "mesh", "--mesh");
    return {stored.mesh.arrays(), sha256_hex(encode_solution(stored.scene, stored.mesh, stored.B, stored.vertex_B,
                                                             stored.eta, stored.edge, stored.middle_B))};
}

StoredSolution solution_lit_alike(const std::string& run, const Scene& scene)
{
    StoredSolution stored = solution_of_surfaces(run, scene, "reference", "reference");
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const Material &theirs = stored.scene.material_of(SurfaceId(s)), &ours = scene.material_of(SurfaceId(s));
        if (theirs.reflectance != ours.reflectance || theirs.emission != ours.emission) {
            throw UsageError("reference",
                             fmt::format("reference: {} of {} reflects or emits otherwise than the scene's {}",
                                         theirs.name, run, ours.name));
        }
    }
    return stored;
}

}  // namespace patchlight
