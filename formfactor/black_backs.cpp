#include "formfactor/black_backs.h"

#include "formfactor/occluded_exchange.h"
#include "formfactor/unoccluded_exchange.h"

#include <array>
#include <cmath>

namespace patchlight {

namespace {

constexpr double tolerance = 1e-5;

struct Back {
    std::array<Vec3, 3> corners;  ///< counter-clockwise seen from the black side
    Vec3 normal{0.0};
};

std::vector<Back> black_backs(const Scene& scene)
{
    std::vector<Back> backs;
    for (const SceneTriangle& t : scene.triangles) {
        const Vec3 &a = scene.vertices[t.vertices[0]], &b = scene.vertices[t.vertices[1]],
                   &c = scene.vertices[t.vertices[2]];
        if (t.front.valid() && !t.back.valid()) backs.push_back({{a, c, b}, -scene.surface(t.front).frame.n});
        if (t.back.valid() && !t.front.valid()) backs.push_back({{a, b, c}, -scene.surface(t.back).frame.n});
    }
    return backs;
}

struct Scratch {
    std::size_t traced = 0;
    std::vector<Blocker> between;
};

double exchange(const Blockers& blockers, std::span<const Vec3> patch, const Vec3& n, const Back& back, double allowed,
                Scratch& scratch)
{
    const Visibility visibility = blockers.between(patch, n, back.corners, back.normal, scratch.between);
    if (visibility == Visibility::hidden) return 0;
    Polygon front_patch, front_back;
    keep_front(patch, back.normal, glm::dot(back.normal, back.corners[0]), blockers.snap(), front_patch);
    keep_front(back.corners, n, glm::dot(n, patch[0]), blockers.snap(), front_back);
    if (visibility == Visibility::visible) return unoccluded_exchange(front_patch, n, front_back, back.normal);
    const ExchangeEstimate part = occluded_exchange(front_patch, n, front_back, back.normal, scratch.between,
                                                    blockers.snap(),
                                                    {.outer = OuterPolygon::first, .tolerance = allowed});
    scratch.traced += part.nodes;
    return part.value;
}

}  // namespace

void add_backs(const Scene& scene, const PatchMesh& mesh, const Blockers& blockers, double least, FormFactorMatrix& F,
               const WorkMonitor& monitor)
{
    std::vector<PatchId> rows;
    for (const PatchId p : mesh.patches())
        if (std::abs(1 - F.raw_sum[p]) > least) rows.push_back(p);
    const std::vector<Back> backs = black_backs(scene);
    F.rays += for_each_row<Scratch>(
        rows.size(), monitor,
        [&](std::size_t k, Scratch& scratch) {
            const PatchId p = rows[k];
            const auto c = mesh.corners(p);
            const std::array<Vec3, 3> patch{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])};
            const Vec3 n = scene.surface(mesh.surface(p)).frame.n;
            double sum = 0;
            for (const Back& back : backs)
                sum += exchange(blockers, patch, n, back, tolerance * mesh.area(p), scratch);
            F.backs[p] = sum / mesh.area(p);
        },
        1);
}

}  // namespace patchlight
