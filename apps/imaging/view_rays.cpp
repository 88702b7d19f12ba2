#include "apps/imaging/view_rays.h"

#include <cmath>
#include <numbers>

namespace patchlight {

namespace {

Vec3 right_of(const Vec3& forward, const Vec3& up)
{
    const Vec3 right = glm::cross(forward, up);
    if (glm::length(right) > 1e-6 * glm::length(up)) {
        return glm::normalize(right);
    }
    const Vec3 axis = std::abs(forward.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, -1};
    return glm::normalize(glm::cross(forward, axis));
}

}  // namespace

ViewRays::ViewRays(const View& view, int width, int height)
    : from_(view.from), half_width_(width / 2.0), half_height_(height / 2.0)
{
    const Vec3 ahead = glm::normalize(view.forward);
    const double half = std::tan(view.vertical_fov * std::numbers::pi / 360.0);
    forward_ = ahead;
    right_ = half * right_of(ahead, view.up);
    down_ = glm::cross(ahead, right_);
}

Vec3 ViewRays::direction(double x, double y) const
{
    const double across = (x - half_width_) / half_height_;
    const double below = (y - half_height_) / half_height_;
    return glm::normalize(forward_ + across * right_ + below * down_);
}

Vec2 ViewRays::project(const Vec3& p) const
{
    const Vec3 d = p - from_;
    const double scale = half_height_ / (glm::dot(d, forward_) * glm::dot(right_, right_));
    return {half_width_ + scale * glm::dot(d, right_), half_height_ + scale * glm::dot(d, down_)};
}

}  // namespace patchlight
