#pragma once

#include "formfactor/facets.h"
#include "formfactor/random_numbers.h"
#include "formfactor/ray_caster.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// A surface seen as a source of light: its convex pieces for Lambert's formula, and points spread over it for
/// shadow rays. Geometry only; how bright it is, is the caller's affair.
class Source {
public:
    Source(const Scene& scene, SurfaceId surface);
    /// Of many surfaces one after the other: `facets` are the surface's.
    Source(const Scene& scene, SurfaceId surface, std::span<const Facet> facets);
    /// Part of a surface: triangles (patches), counter-clockwise seen from its front.
    Source(SurfaceId surface, const Vec3& normal, std::span<const std::array<Vec3, 3>> triangles);

    SurfaceId surface() const { return surface_; }
    const Vec3& normal() const { return normal_; }

    /// Its factor seen from the point p with normal n, nothing in between.
    double unoccluded(const Vec3& p, const Vec3& n) const;

    /// The point of the source for (u, v) in the unit square; equal areas go to equal areas.
    Vec3 point(double u, double v) const;

private:
    struct Triangle {
        Vec3 corner, edge0, edge1;
        double until = 0;  ///< share of the area up to and with this triangle
    };
    void divide();

    SurfaceId surface_;
    Vec3 normal_{0.0};
    bool parallelogram_ = false;
    std::vector<std::vector<Vec3>> pieces_;
    std::vector<Triangle> triangles_;
};

/// A place to look from.
struct ReceiverPoint {
    Vec3 position{0.0};
    Vec3 normal{0.0};
};

/// A shadow ray that got through: which point of the source it saw, and its part of the factor.
struct VisibleSample {
    Vec3 point{0.0};
    double weight = 0;
};

/// Working memory of `visible_factor`, reused from call to call.
struct ShadowScratch {
    RayBatch rays;
    std::vector<std::uint8_t> blocked;
    std::vector<double> weights;
    std::vector<VisibleSample> visible;  ///< out: weights sum to the factor
    std::size_t traced = 0;              ///< rays since the scratch was made
};

/// The factor of a source: Lambert's formula (mean over the receivers) times the visible fraction, which shadow
/// rays to jittered strata of the source find, each weighed by its own unoccluded part (a ratio estimator: exact
/// where nothing hides the source). Ray k leaves from receiver k mod receivers.size().
/// With one receiver a sixteenth of the rays (16 at least) goes first, and decides alone if all agree.
/// `rays` is rounded up to a square. Source of the idea: [WallaceElmquistHaines89].
double visible_factor(const RayCaster& caster, const Source& source, std::span<const ReceiverPoint> receivers, int rays,
                      RandomNumbers& random, ShadowScratch& scratch);

}  // namespace patchlight
