#pragma once

#include "apps/verification/surface_sampler.h"
#include "formfactor/random_numbers.h"
#include "formfactor/ray_caster.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace patchlight {

/// How emitters are found along a path.
enum class FindEmitters {
    drawn,     ///< a point of one emitter is drawn at every vertex, weighed against what the path hits by chance
    by_chance  ///< only emission that the path hits counts: for rooms that emit all over
};

/// Estimates radiosity by following light backwards, from surface to surface: rays against the input polygons, and no
/// form factor, no patch, nothing of the solver. Unbiased but for rays that pass within 1e-6 of the scene's diameter
/// of an edge. Diffuse, one-sided, three bands along one path. Source: [Kajiya86], [VeachGuibas95].
class PathTracer {
public:
    /// `emitters` unset: by chance where half of all surface or more emits, else drawn. Keeps references.
    PathTracer(const Scene& scene, const RayCaster& caster, std::uint64_t seed,
               std::optional<FindEmitters> emitters = {});

    struct Scratch;

    /// Adds what paths first … first + count − 1 of a stream find to `sum`: each estimates the reflected part B − E of
    /// a point, W/m². A stream's first directions and light points are one scrambled sequence: 2^k of them are
    /// stratified. Different streams are independent; the result depends on seed, stream and path alone.
    void add_paths(const DrawnPoint& from, std::uint64_t stream, std::uint32_t first, std::uint32_t count, Rgb& sum,
                   Scratch& scratch) const;

private:
    struct Path {
        Vec3 position{0.0};
        SurfaceId surface;
        Rgb carried{0.0};  ///< by which B at the vertex's own irradiance is still to be multiplied
        std::array<double, 2> light_numbers{}, direction_numbers{};
        RandomNumbers random;
    };

    void begin(const DrawnPoint& from, std::uint64_t stream, std::uint32_t first, std::uint32_t count,
               Scratch& scratch) const;
    void draw_emitters(Rgb& sum, Scratch& scratch) const;
    void follow(Rgb& sum, Scratch& scratch) const;
    bool reflect(Path& path, SurfaceId surface, const Vec3& position) const;

    const Scene& scene_;
    const RayCaster& caster_;
    SurfaceSampler emitters_;
    std::uint64_t seed_;
    FindEmitters how_;
};

/// A thread's own.
struct PathTracer::Scratch {
    std::vector<Path> paths;
    std::vector<Rgb> arriving;
    RayBatch rays;
    HitBatch hits;
    std::vector<std::uint8_t> blocked;
    std::vector<Vec3> directions;
    std::size_t traced = 0;  ///< rays so far
};

}  // namespace patchlight
