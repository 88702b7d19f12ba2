#include "meshing/plane_frame.h"

#include <cmath>

namespace patchlight {

Vec3 cleaned_normal(const Vec3& normal)
{
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 exact{0.0};
        exact[axis] = normal[axis] < 0 ? -1 : 1;
        if (glm::length(normal - exact) <= 1e-12) return exact;
    }
    return normal;
}

PlaneFrame frame_with_normal(const Vec3& origin, const Vec3& normal, const Vec3& direction)
{
    PlaneFrame frame;
    frame.origin = origin;
    frame.n = cleaned_normal(normal);
    for (int axis = 0; axis < 3; ++axis) {
        // Tilted by less than 1e-8 a component rounds to 1 already: the others must vanish.
        if (std::abs(frame.n[axis]) != 1 || frame.n[(axis + 1) % 3] != 0 || frame.n[(axis + 2) % 3] != 0) continue;
        frame.u = frame.v = Vec3{0.0};
        frame.u[(axis + 1) % 3] = 1;
        frame.v[(axis + 2) % 3] = 1;
        if (frame.n[axis] < 0) std::swap(frame.u, frame.v);
        return frame;
    }
    Vec3 u = direction - glm::dot(direction, frame.n) * frame.n;
    u = glm::normalize(u);
    frame.u = glm::normalize(u - glm::dot(u, frame.n) * frame.n);
    frame.v = glm::cross(frame.n, frame.u);
    return frame;
}

PlaneFrame turned_over(const PlaneFrame& frame)
{
    PlaneFrame back = frame;
    std::swap(back.u, back.v);
    back.n = Vec3{0.0} - frame.n;  // no negative zeros
    return back;
}

}  // namespace patchlight
