#pragma once

#include "tests/verification/path_traced_reference_scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace patchlight::reference {

/// How emitters are found along a path.
enum class FindEmitters {
    drawn,  ///< a point of each emitter is drawn at every vertex, and what the path hits counts too: for small emitters
    by_chance  ///< only emission that the path hits counts: for rooms that emit all over, and as a check on `drawn`
};

struct PathOptions {
    int replicates = 32;        ///< independent repetitions, ≥ 2: their spread gives the standard error
    int light_strata = 16;      ///< n × n points on each emitter, a replicate, for the direct light
    int direction_strata = 30;  ///< n × n first directions, a replicate
    FindEmitters emitters = FindEmitters::drawn;
    std::uint64_t seed = 1;
};

struct Measured {
    Rgb mean{0.0};
    Rgb standard_error{0.0};
};

/// Irradiance (W/m²) of one point: of the emitters alone, and of everything.
struct Irradiance {
    Measured direct;
    Measured total;
};

/// Estimates the irradiance of a point on a surface with normal n. Unbiased; `index` keys the random numbers,
/// so that the answer depends on (seed, index) only. With by_chance, `direct` is 0 and `total` holds all.
Irradiance measure_irradiance(const ReferenceScene& scene, const Vec3& p, const Vec3& n, const PathOptions& options,
                              std::uint64_t index);

struct SurfacePoint {
    std::size_t polygon = 0;
    Vec3 position;
};

/// Area-uniform random points over everything that reflects, further than 1e-6 diameters from the polygon's border.
std::vector<SurfacePoint> sample_points(const ReferenceScene& scene, std::size_t count, std::uint64_t seed);

}  // namespace patchlight::reference
