#pragma once

#include "meshing/scene.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace patchlight {

/// A point of a surface's front, in the scene's recentred metres.
struct DrawnPoint {
    SurfaceId surface;
    Vec3 position{0.0};
};

/// Draws points of the surfaces' fronts, uniform within a surface, with a weight of its own for each surface.
class SurfaceSampler {
public:
    /// `weight` of a surface per m², ≥ 0; surfaces of weight 0 are never drawn. Keeps a reference to the scene.
    SurfaceSampler(const Scene& scene, const std::function<double(SurfaceId)>& weight);

    /// ∫ weight dA. With 0 there is nothing to draw.
    double total() const { return total_; }

    /// The point of two numbers of [0, 1): a stratified unit square gives stratified points.
    DrawnPoint at(double u, double v) const;

    /// Per m² of the surface, the density with which at() draws there.
    double density(SurfaceId surface) const { return density_[surface.value]; }

private:
    struct Side {
        std::uint32_t triangle = 0;
        SurfaceId surface;
        double before = 0;  ///< ∫ weight dA of all sides before this one
        double weight = 0;  ///< ∫ weight dA of this one
    };

    const Scene* scene_;
    std::vector<Side> sides_;  ///< front or back of a triangle of the scene
    std::vector<double> density_;
    double total_ = 0;
};

/// Uniform over all surface that reflects, ρ > 0.
SurfaceSampler reflecting_surface(const Scene& scene);

/// `count` of its points, one in each of as many equal parts of the area. Empty when nothing reflects.
std::vector<DrawnPoint> draw_points(const SurfaceSampler& surface, std::size_t count, std::uint64_t seed);

}  // namespace patchlight
