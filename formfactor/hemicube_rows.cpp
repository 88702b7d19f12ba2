#include "formfactor/hemicube_rows.h"

#include "formfactor/compressed_rows.h"
#include "formfactor/hemicube.h"
#include "formfactor/random_numbers.h"
#include "formfactor/ray_caster.h"

#include <memory>
#include <numbers>
#include <vector>

namespace patchlight {

namespace {

struct HemicubeScratch {
    std::unique_ptr<Hemicube> cube;
    HemicubeSums sums;
    FormFactorRow row;
    std::size_t traced = 0;  ///< pixels
};

/// The patches, item by item, and then the triangles of no surface, that count as backs on both sides.
std::vector<HemicubeTriangle> triangles_of(const Scene& scene, const PatchMesh& mesh)
{
    std::vector<HemicubeTriangle> triangles;
    triangles.reserve(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        const auto c = mesh.corners(p);
        triangles.push_back({{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])}, p.value});
    }
    const auto black = static_cast<std::uint32_t>(mesh.patch_count());
    for (const SceneTriangle& t : scene.triangles)
        if (!t.front.valid() && !t.back.valid())
            triangles.push_back(
                {{scene.vertices[t.vertices[0]], scene.vertices[t.vertices[1]], scene.vertices[t.vertices[2]]}, black});
    return triangles;
}

/// The sums as a row of patches.
void fill_row(const HemicubeSums& sums, std::size_t patches, FormFactorRow& row)
{
    row.patches.clear();
    row.factors.clear();
    row.raw_sum = 0;
    row.escaped = sums.escaped;
    row.backs = sums.backs;
    for (std::size_t k = 0; k < sums.items.size(); ++k) {
        if (sums.items[k] >= patches) {
            row.backs += sums.factors[k];
            continue;
        }
        row.patches.emplace_back(sums.items[k]);
        row.factors.push_back(sums.factors[k]);
        row.raw_sum += sums.factors[k];
    }
}

}  // namespace

FormFactorMatrix hemicube_rows(const Scene& scene, const PatchMesh& mesh, const FormFactorOptions& options,
                               const WorkMonitor& monitor)
{
    const Hemicube checked(options.resolution);  // throws here, not on a worker's thread
    const std::vector<HemicubeTriangle> triangles = triangles_of(scene, mesh);
    const std::size_t patches = mesh.patch_count();
    CompressedRows rows(patches);
    const std::size_t pixels =
        for_each_row<HemicubeScratch>(patches, monitor, [&](std::size_t i, HemicubeScratch& scratch) {
            if (!scratch.cube) scratch.cube = std::make_unique<Hemicube>(options.resolution);
            const PatchId patch(i);
            PlaneFrame frame = scene.surface(mesh.surface(patch)).frame;
            frame.origin = mesh.centroid(patch) + departure * scene.diameter * frame.n;
            RandomNumbers random(options.seed, i);
            scratch.cube->render(triangles, frame, 2 * std::numbers::pi * random.uniform());
            scratch.cube->sum(scratch.sums);
            fill_row(scratch.sums, patches, scratch.row);
            scratch.traced += scratch.cube->pixels();
            rows.put(patch, scratch.row);
        });
    return rows.matrix(pixels);
}

}  // namespace patchlight
