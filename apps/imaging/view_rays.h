#pragma once

#include "meshing/scene.h"

namespace patchlight {

class RayCaster;

/// The rays of a pinhole camera through the points of a picture.
class ViewRays {
public:
    /// The vertical field of view fills the picture's height; pixels are square. An `up` along the direction of
    /// view is replaced by an axis.
    ViewRays(const View& view, int width, int height);

    const Vec3& from() const { return from_; }

    /// Through (x, y) in pixels, from the left and the top: (0.5, 0.5) is the centre of the first pixel. Unit length.
    Vec3 direction(double x, double y) const;

    /// How far a point is in front of the camera, along the direction of view.
    double depth(const Vec3& p) const { return glm::dot(p - from_, forward_); }
    /// Where a point is seen, in pixels as in direction(); its depth must be positive.
    Vec2 project(const Vec3& p) const;

private:
    Vec3 from_;
    Vec3 forward_;
    Vec3 right_;  ///< of half the picture's height
    Vec3 down_;
    double half_width_;
    double half_height_;
};

/// A camera for a scene that has none: of a fixed set of places (in the corners of the bounding box, looking to
/// the opposite one; before the largest surfaces; for open scenes also before each side of the box) the one from which
/// most of the picture shows fronts of surfaces, and many different ones. y is taken as up.
View default_view(const Scene& scene, const RayCaster& caster);

}  // namespace patchlight
