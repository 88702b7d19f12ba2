#include "formfactor/ray_caster.h"

#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

namespace patchlight {

namespace {

constexpr std::size_t width = 8;  // one kernel throughout: packets of 8

/// Where a triangle's corner 0 and its edges lie in the plane of the surface on one side.
struct PlaneSide {
    float x0, y0, x1, y1, x2, y2;  // corner, then the two edge vectors from it
    std::uint32_t surface;
};

/// The widest instruction set that we allow: with AVX-512 Embree's hits differ in the last bits, and packets
/// of 8 gain nothing from it.
const char* instruction_set_of_this_machine()
{
    if (__builtin_cpu_supports("avx2")) return "avx2";
    if (__builtin_cpu_supports("sse4.2")) return "sse4.2";
    return "sse2";
}

PlaneSide side_of(const Scene& scene, const SceneTriangle& triangle, SurfaceId surface)
{
    if (!surface.valid()) return {0, 0, 0, 0, 0, 0, HitBatch::black_back};
    const PlaneFrame& frame = scene.surface(surface).frame;
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = frame.to_plane(scene.vertices[triangle.vertices[k]]);
    const auto f = [](double x) { return static_cast<float>(x); };
    return {f(p[0].x),          f(p[0].y),          f(p[1].x - p[0].x), f(p[1].y - p[0].y),
            f(p[2].x - p[0].x), f(p[2].y - p[0].y), surface.value};
}

/// Embree takes twice a triangle's area below 1e-18 for nothing, and products of three lengths overflow or vanish: so
/// its scenes are about a thousand across, whatever ours are. A power of two: exact, so that all hits stay what they
/// are.
float embree_scale(double diameter)
{
    return diameter > 0 ? std::ldexp(1.0F, 10 - std::ilogb(diameter)) : 1.0F;
}

/// Of Embree's own lengths, in which scenes are about a thousand across. From further away single precision doesn't
/// know where a ray passes them, and Embree aborts at last.
constexpr float farthest_origin = 1e9F;

/// Ray `from` of the batch, as ray k of the packet, of which the hit is not touched. A segment is scaled as a whole;
/// what has no end has no length: its direction remains. Returns what Embree takes for valid: -1, or 0 for a ray that
/// it could make nothing of.
template <typename Packet>
int set_ray(Packet& packet, std::size_t k, const RayBatch& rays, std::size_t from, float scale)
{
    const float along = std::isinf(rays.reach[from]) ? 1.0F : scale;
    packet.org_x[k] = scale * rays.ox[from];
    packet.org_y[k] = scale * rays.oy[from];
    packet.org_z[k] = scale * rays.oz[from];
    packet.dir_x[k] = along * rays.dx[from];
    packet.dir_y[k] = along * rays.dy[from];
    packet.dir_z[k] = along * rays.dz[from];
    packet.tnear[k] = 0;
    packet.tfar[k] = rays.reach[from];
    packet.time[k] = 0;
    packet.mask[k] = ~0U;
    packet.id[k] = 0;
    packet.flags[k] = 0;
    // Neither holds of what is not a number.
    const float away = std::abs(packet.org_x[k]) + std::abs(packet.org_y[k]) + std::abs(packet.org_z[k]);
    const float length = std::abs(packet.dir_x[k]) + std::abs(packet.dir_y[k]) + std::abs(packet.dir_z[k]);
    return away <= farthest_origin && length <= std::numeric_limits<float>::max() ? -1 : 0;
}

/// What a call of Embree failed at.
[[noreturn]] void complain(RTCError error, const char* what)
{
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(what);
}

}  // namespace

struct RayCaster::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::array<PlaneSide, 2>> sides;  // of each triangle: front, back
    std::string isa;
    float scale = 1;  // from metres to Embree's own lengths

    ~Impl()
    {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

void RayBatch::resize(std::size_t n)
{
    size_ = n;
    const std::size_t padded = (n + width - 1) / width * width;
    for (auto* array : {&ox, &oy, &oz, &dx, &dy, &dz, &reach})
        if (array->size() < padded) array->resize(padded, 1.0F);
}

void RayBatch::set(std::size_t i, const Vec3& origin, const Vec3& direction, float how_far)
{
    ox[i] = static_cast<float>(origin.x);
    oy[i] = static_cast<float>(origin.y);
    oz[i] = static_cast<float>(origin.z);
    dx[i] = static_cast<float>(direction.x);
    dy[i] = static_cast<float>(direction.y);
    dz[i] = static_cast<float>(direction.z);
    reach[i] = how_far;
}

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_unique<Impl>()), offset_(departure * scene.diameter)
{
    impl_->isa = instruction_set_of_this_machine();
    impl_->device = rtcNewDevice(("isa=" + impl_->isa).c_str());
    if (impl_->device == nullptr) {
        // Without memory for its threads it says unknown.
        const RTCError cause = rtcGetDeviceError(nullptr);
        if (cause == RTC_ERROR_OUT_OF_MEMORY || cause == RTC_ERROR_UNKNOWN) throw std::bad_alloc();
        throw std::runtime_error("Embree can't start on this machine");
    }
    impl_->scene = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
    impl_->scale = embree_scale(scene.diameter);

    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), scene.vertices.size()));
    auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), scene.triangles.size()));
    if (vertices == nullptr || triangles == nullptr) throw std::bad_alloc();
    for (std::size_t v = 0; v < scene.vertices.size(); ++v)
        for (int k = 0; k < 3; ++k)
            vertices[3 * v + static_cast<std::size_t>(k)] = impl_->scale * static_cast<float>(scene.vertices[v][k]);
    impl_->sides.reserve(scene.triangles.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const SceneTriangle& triangle = scene.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) triangles[3 * t + k] = triangle.vertices[k];
        impl_->sides.push_back({side_of(scene, triangle, triangle.front), side_of(scene, triangle, triangle.back)});
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(impl_->scene);
    if (const RTCError error = rtcGetDeviceError(impl_->device); error != RTC_ERROR_NONE)
        complain(error, "Embree could not build the scene");
}

RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

std::string RayCaster::instruction_set() const
{
    return impl_->isa;
}

void RayCaster::closest(const RayBatch& rays, HitBatch& hits) const
{
    const std::size_t n = rays.size();
    hits.surface.resize(n);
    hits.x.resize(n);
    hits.y.resize(n);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(32) RTCRayHit8 packet{};  // Embree looks at what isn't valid, too
    alignas(32) std::array<int, width> valid;
    for (std::size_t first = 0; first < n; first += width) {
        for (std::size_t k = 0; k < width; ++k) {
            valid[k] = first + k < n ? set_ray(packet.ray, k, rays, first + k, impl_->scale) : 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect8(valid.data(), impl_->scene, &context, &packet);
        for (std::size_t k = 0; k < width && first + k < n; ++k) {
            std::uint32_t surface = HitBatch::escaped;
            float x = 0, y = 0;
            if (packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID) {
                const float facing = packet.hit.Ng_x[k] * packet.ray.dir_x[k] +
                                     packet.hit.Ng_y[k] * packet.ray.dir_y[k] +
                                     packet.hit.Ng_z[k] * packet.ray.dir_z[k];
                const PlaneSide& side = impl_->sides[packet.hit.primID[k]][facing < 0 ? 0 : 1];
                surface = side.surface;
                x = side.x0 + packet.hit.u[k] * side.x1 + packet.hit.v[k] * side.x2;
                y = side.y0 + packet.hit.u[k] * side.y1 + packet.hit.v[k] * side.y2;
            }
            hits.surface[first + k] = surface;
            hits.x[first + k] = x;
            hits.y[first + k] = y;
        }
    }
}

void RayCaster::occluded(const RayBatch& rays, std::vector<std::uint8_t>& blocked) const
{
    const std::size_t n = rays.size();
    blocked.resize(n);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(32) RTCRay8 packet{};
    alignas(32) std::array<int, width> valid;
    for (std::size_t first = 0; first < n; first += width) {
        for (std::size_t k = 0; k < width; ++k) {
            valid[k] = first + k < n ? set_ray(packet, k, rays, first + k, impl_->scale) : 0;
        }
        rtcOccluded8(valid.data(), impl_->scene, &context, &packet);
        for (std::size_t k = 0; k < width && first + k < n; ++k) blocked[first + k] = packet.tfar[k] < 0 ? 1 : 0;
    }
}

}  // namespace patchlight
