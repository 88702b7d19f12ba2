// Rays per second of form-factor assembly beside bare Embree on the same rays, in the same run: patch by patch, in
// turn, so that a machine that slows down slows all of them. One thread.
//   assembly       directions, origins, trace on the surfaces, patch location, accumulation
//   bare_patches   Embree alone, of the same rays, on a BVH of the patch triangles (the primitive is the patch);
//                  the faster of packets of 8 and single rays
//   bare_surfaces  the same on the BVH of the surfaces
#include "formfactor/row_sampler.h"
#include "meshing/read_scene.h"
#include "meshing/refinement.h"

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace patchlight {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Embree and nothing else.
class BareEmbree {
public:
    BareEmbree(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
        : device_(rtcNewDevice("isa=avx2")), scene_(rtcNewScene(device_))
    {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                              3 * sizeof(float), vertices.size()));
        auto* t = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
        for (const Vec3& p : vertices)
            for (int k = 0; k < 3; ++k) *v++ = static_cast<float>(p[k]);
        for (const auto& triangle : triangles)
            for (const std::uint32_t corner : triangle) *t++ = corner;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;
    ~BareEmbree()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// Traces ready-made packets; only this is timed.
    void trace(std::vector<RTCRayHit8>& packets) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        alignas(32) const std::array<int, 8> all{-1, -1, -1, -1, -1, -1, -1, -1};
        for (RTCRayHit8& packet : packets) rtcIntersect8(all.data(), scene_, &context, &packet);
    }

    /// The same one ray at a time: faster where rays part quickly.
    void trace(std::vector<RTCRayHit>& rays) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (RTCRayHit& ray : rays) rtcIntersect1(scene_, &context, &ray);
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

void fill(const RayBatch& rays, std::vector<RTCRayHit8>& packets)
{
    packets.resize(rays.size() / 8);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRayHit8& p = packets[i / 8];
        const std::size_t k = i % 8;
        p.ray.org_x[k] = rays.ox[i];
        p.ray.org_y[k] = rays.oy[i];
        p.ray.org_z[k] = rays.oz[i];
        p.ray.dir_x[k] = rays.dx[i];
        p.ray.dir_y[k] = rays.dy[i];
        p.ray.dir_z[k] = rays.dz[i];
        p.ray.tnear[k] = 0;
        p.ray.tfar[k] = rays.reach[i];
        p.ray.time[k] = 0;
        p.ray.mask[k] = ~0U;
        p.ray.flags[k] = 0;
        p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
}

void fill(const RayBatch& rays, std::vector<RTCRayHit>& singles)
{
    singles.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        singles[i].ray = {rays.ox[i], rays.oy[i], rays.oz[i],    0,   rays.dx[i], rays.dy[i],
                          rays.dz[i], 0,          rays.reach[i], ~0U, 0,          0};
        singles[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
}

/// Seconds that bare Embree takes for the rays of `batch`, in packets and one by one.
struct BareSeconds {
    double packets = 0, singles = 0;

    void add(const BareEmbree& embree, const RayBatch& batch, std::vector<RTCRayHit8>& as_packets,
             std::vector<RTCRayHit>& as_singles)
    {
        fill(batch, as_packets);
        auto begin = Clock::now();
        embree.trace(as_packets);
        packets += since(begin);
        fill(batch, as_singles);
        begin = Clock::now();
        embree.trace(as_singles);
        singles += since(begin);
    }
    double best() const { return std::min(packets, singles); }
};

void assembly_beside_bare_embree(benchmark::State& state)
{
    SceneOptions in_millimetres;
    in_millimetres.unit = 1e-3;
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", in_millimetres).scene;
    const PatchMesh mesh = triangulate(scene, {.max_elements = static_cast<std::size_t>(state.range(0))});
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    const RowSampler sampler(scene, caster, mesh, locator, {}, {.rays = 512});

    const BareEmbree patches(mesh.arrays().positions, mesh.arrays().triangles);
    std::vector<std::array<std::uint32_t, 3>> surface_triangles;
    for (const SceneTriangle& t : scene.triangles) surface_triangles.push_back(t.vertices);
    const BareEmbree surfaces(scene.vertices, surface_triangles);

    RowScratch scratch;
    std::vector<RTCRayHit8> packets;
    std::vector<RTCRayHit> singles;
    BareSeconds on_patches, on_surfaces;
    double assembling = 0, rays = 0;
    for (auto _ : state) {
        double spent = 0;
        // Every patch would take long at 20k; a stride of a prime visits all surfaces.
        for (std::size_t i = 0; i < 1024; ++i) {
            const PatchId patch(i * 7919 % mesh.patch_count());
            const auto begin = Clock::now();
            sampler.patch_row(patch, scratch);
            spent += since(begin);
            rays += static_cast<double>(scratch.rays.size());
            on_patches.add(patches, scratch.rays, packets, singles);
            on_surfaces.add(surfaces, scratch.rays, packets, singles);
        }
        assembling += spent;
        state.SetIterationTime(spent);
    }
    state.counters["patches"] = static_cast<double>(mesh.patch_count());
    state.counters["assembly"] = rays / assembling;
    state.counters["bare_patches"] = rays / on_patches.best();
    state.counters["bare_surfaces"] = rays / on_surfaces.best();
    state.counters["of_bare_patches"] = on_patches.best() / assembling;
    state.counters["of_bare_surfaces"] = on_surfaces.best() / assembling;
}
BENCHMARK(assembly_beside_bare_embree)->Arg(1000)->Arg(20000)->UseManualTime()->MinTime(2);

}  // namespace
}  // namespace patchlight

BENCHMARK_MAIN();
