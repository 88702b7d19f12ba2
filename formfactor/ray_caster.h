#pragma once

#include "meshing/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// How far in front of its surface begins what looks out from it, in diameters of the scene: several times what single
/// precision can confuse, and far above what snapping moves.
inline constexpr double departure = 1e-6;

/// Rays as structure of arrays, in the scene's recentred metres. Reused from batch to batch: no allocation in
/// a hot loop. Neighbouring rays should be similar: they are traced in packets of 8.
struct RayBatch {
    std::vector<float> ox, oy, oz;  ///< origins
    std::vector<float> dx, dy, dz;  ///< directions, any length > 0
    std::vector<float> reach;       ///< how far to look, in lengths of the direction

    /// Makes room for n rays (the arrays grow to a multiple of 8; the padding is never traced).
    void resize(std::size_t n);
    std::size_t size() const { return size_; }
    void set(std::size_t i, const Vec3& origin, const Vec3& direction, float how_far);

private:
    std::size_t size_ = 0;
};

/// What a ray met first. `surface` is the surface whose front was hit, or one of the two values below;
/// x, y are the plane coordinates of the hit in that surface's frame.
struct HitBatch {
    static constexpr std::uint32_t escaped = 0xffffffffU;     ///< met nothing
    static constexpr std::uint32_t black_back = 0xfffffffeU;  ///< met the back of a one-sided surface

    std::vector<std::uint32_t> surface;
    std::vector<float> x, y;
};

/// Visibility among the surfaces of a scene, by Embree: one BVH over the scene's triangles (the input polygons,
/// never the patches), built once, ROBUST. All queries may be made from many threads at once, and answer the
/// same whatever the number of threads. Single precision inside: what comes from more than about a million of the
/// scene's diameters away, or isn't finite, meets nothing.
class RayCaster {
public:
    explicit RayCaster(const Scene& scene);
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;
    ~RayCaster();

    /// The first surface along each ray. `hits` is resized to rays.size().
    void closest(const RayBatch& rays, HitBatch& hits) const;

    /// blocked[i] = 1 when anything stands on ray i before its reach.
    void occluded(const RayBatch& rays, std::vector<std::uint8_t>& blocked) const;

    /// Where a ray must start that leaves the point p of a surface with normal n.
    Vec3 leave(const Vec3& p, const Vec3& n) const { return p + offset_ * n; }

    /// The instruction set Embree runs with: hits agree to the bit only within one.
    std::string instruction_set() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    double offset_ = 0;
};

}  // namespace patchlight
