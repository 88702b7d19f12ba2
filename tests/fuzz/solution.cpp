#include "apps/run/exporting.h"
#include "apps/run/probing.h"
#include "apps/run/stored_snapshots.h"
#include "apps/run/vtu_file.h"
#include "formfactor/ray_caster.h"
#include "meshing/scene_error.h"
#include "tests/fuzz/made_run.h"

#include <stdexcept>

using namespace patchlight;

namespace {

/// What commands do with a stored solution, whatever stands in it.
void use(const StoredSolution& solution, const std::string& bytes)
{
    std::vector<ProbePoint> points;
    for (const PatchId patch : solution.mesh.patches()) {
        const Vec3 place = (solution.mesh.centroid(patch) + solution.scene.center) / solution.scene.unit;
        points.push_back({place, solution.scene.surface(solution.mesh.surface(patch)).frame.n, {}});
        points.push_back({place, {}, {}});
    }
    SurfaceProbe(solution).at(points);
    encode_ply(solution);
    encode_csv(solution);
    encode_vtu(solution);
    const RayCaster caster(solution.scene);
    const auto encoded = [](const StoredSolution& s) {
        return encode_solution(s.scene, s.mesh, s.B, s.vertex_B, s.eta, s.edge, s.middle_B);
    };
    const std::string again = encoded(solution);
    if (encoded(decode_solution(again, "again")) != again)
        throw std::logic_error("a solution of " + std::to_string(bytes.size()) + " bytes changes by being read");
}

}  // namespace

/// A solution.glb, or, where it doesn't begin like one, changes to one that is whole.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::string bytes = testing::text_of(data, size);
    if (!bytes.starts_with("glTF")) {
        testing::Choices choices(data, size);
        bytes = testing::damaged(testing::made_run().cycles.back(), choices);
    }
    StoredSolution solution;
    try {
        solution = decode_solution(bytes, "fuzzed.glb");
    } catch (const SceneError&) {
        return 0;
    }
    use(solution, bytes);
    return 0;
}
