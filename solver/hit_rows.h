#pragma once

#include "formfactor/hemisphere.h"
#include "solver/gather.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

struct HitRowOptions {
    int rays = 512;  ///< over the hemisphere at each point, 16 … 65536
    HemisphereDirections directions = HemisphereDirections::stratified;
    std::uint64_t seed = 1;
    std::size_t most_bytes = std::size_t{1} << 30;  ///< of hits kept; points beyond are traced again for each answer
};

/// Rays over the hemispheres at points, and where on the patches of a mesh they end: the irradiance of the points for
/// any light that leaves that mesh. Hits are kept, 8 bytes a ray, so that a second sweep traces nothing. Points of one
/// surface share their directions: what the rays don't resolve varies smoothly over it. Keeps references to all that
/// the exchange refers to.
class HitRows {
public:
    HitRows(const Exchange& exchange, const HitRowOptions& options);

    /// Traces the rays of more points; they are known by their order of coming. Throws Interrupted.
    void add(std::span<const SurfacePoint> points, const WorkMonitor& monitor = {});

    /// Σ ΔF · (light leaving at the hit), W/m², at the given points; 0 where nothing is reflected. Throws Interrupted.
    std::vector<Rgb> irradiance(std::span<const std::uint32_t> points, const QuadraticRadiosity& leaving,
                                const WorkMonitor& monitor = {});

    bool keeps_all() const { return keeps_all_; }
    std::size_t rays() const { return rays_; }  ///< traced so far

private:
    /// Two barycentric coordinates in 65,535ths; the third is the rest.
    struct Hit {
        std::uint32_t patch;
        std::uint16_t w0, w1;
    };
    struct Triangle {
        float x0, y0, a0, b0, a1, b1;
    };
    struct Scratch {
        RayBatch rays;
        HitBatch hits;
        std::vector<PatchId> found;
        std::vector<Hit> row;
        std::size_t traced = 0;
    };
    static constexpr std::uint32_t dark = 0xffffffffU;

    void trace(const SurfacePoint& point, std::vector<Hit>& row, Scratch& scratch) const;
    bool reflects(const SurfacePoint& point) const;

    Exchange exchange_;
    HitRowOptions options_;
    std::vector<HemisphereSet> sets_;
    std::vector<Triangle> triangles_;  ///< by patch
    std::vector<SurfacePoint> points_;
    std::vector<std::vector<Hit>> kept_;  ///< of each point; empty: not kept
    std::size_t bytes_ = 0;
    bool keeps_all_ = true;
    std::size_t rays_ = 0;
};

}  // namespace patchlight
