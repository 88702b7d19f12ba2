#include "solver/random_ray.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

void set_random_ray(const Exchange& exchange, PatchId patch, RandomNumbers& random, std::size_t i, RayBatch& batch)
{
    const PatchMesh& mesh = exchange.mesh;
    const PlaneFrame& frame = exchange.scene.surface(mesh.surface(patch)).frame;
    const auto c = mesh.corners(patch);
    const double root = std::sqrt(random.uniform()), split = random.uniform();
    const Vec3& origin = mesh.position(c[0]);
    const Vec3 place =
        origin + root * (1 - split) * (mesh.position(c[1]) - origin) + root * split * (mesh.position(c[2]) - origin);
    const double r2 = random.uniform(), phi = 2 * std::numbers::pi * random.uniform();
    const Vec3 direction =
        std::sqrt(r2) * (std::cos(phi) * frame.u + std::sin(phi) * frame.v) + std::sqrt(1 - r2) * frame.n;
    batch.set(i, exchange.caster.leave(place, frame.n), direction, std::numeric_limits<float>::infinity());
}

}  // namespace patchlight
