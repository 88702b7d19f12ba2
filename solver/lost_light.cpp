#include "solver/lost_light.h"

#include "formfactor/work_monitor.h"
#include "meshing/union_find.h"
#include "solver/random_ray.h"

#include <algorithm>
#include <vector>

namespace patchlight {

LostLight lost_light(const Exchange& exchange, const Radiosity& B, std::size_t rays, std::uint64_t seed)
{
    const PatchMesh& mesh = exchange.mesh;
    std::vector<double> power_upto(1, 0.0);
    for (const PatchId p : mesh.patches())
        power_upto.push_back(power_upto.back() + mesh.area(p) * (B[p].r + B[p].g + B[p].b));
    const double power = power_upto.back();
    if (!(power > 0)) return {};
    RayBatch batch;
    batch.resize(rays);
    RandomNumbers random(seed, rays);
    std::size_t patch = 0;
    for (std::size_t i = 0; i < rays; ++i) {
        const double target = power * (static_cast<double>(i) + random.uniform()) / static_cast<double>(rays);
        while (patch + 1 < B.size() && power_upto[patch + 1] <= target) ++patch;
        set_random_ray(exchange, PatchId(patch), random, i, batch);
    }
    HitBatch hits;
    exchange.caster.closest(batch, hits);
    const auto share = [&](std::uint32_t what) {
        return static_cast<double>(std::ranges::count(hits.surface, what)) / static_cast<double>(rays);
    };
    return {power * share(HitBatch::escaped), power * share(HitBatch::black_back)};
}

std::vector<std::uint8_t> lit_surfaces(const Exchange& exchange, std::uint64_t seed)
{
    constexpr std::size_t rays = 32;
    struct Scratch {
        RayBatch batch;
        HitBatch hits;
        std::size_t traced = 0;
    };
    const std::size_t n = exchange.scene.surfaces.size();
    std::vector<std::uint32_t> met(n * rays, HitBatch::escaped);
    for_each_row<Scratch>(n, {}, [&](std::size_t s, Scratch& scratch) {
        const IdRange<PatchId> patches = exchange.mesh.patches_of(SurfaceId(s));
        if (patches.size() == 0) return;
        RandomNumbers random(seed, s);
        scratch.batch.resize(rays);
        for (std::size_t i = 0; i < rays; ++i)
            set_random_ray(exchange, PatchId(patches.first + i * patches.size() / rays), random, i, scratch.batch);
        exchange.caster.closest(scratch.batch, scratch.hits);
        std::ranges::copy(scratch.hits.surface, met.begin() + static_cast<std::ptrdiff_t>(s * rays));
    });
    UnionFind rooms(n);
    for (std::size_t k = 0; k < met.size(); ++k)
        if (met[k] < n) rooms.join(static_cast<std::uint32_t>(k / rays), met[k]);
    std::vector<std::uint8_t> room_lit(n, 0), lit(n, 0);
    for (const SurfaceId s : emitters(exchange.scene)) room_lit[rooms.root(s.value)] = 1;
    for (std::size_t s = 0; s < n; ++s) lit[s] = room_lit[rooms.root(static_cast<std::uint32_t>(s))];
    return lit;
}

}  // namespace patchlight
