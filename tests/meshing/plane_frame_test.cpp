#include "meshing/plane_frame.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace patchlight;

namespace {

void expect_orthonormal(const PlaneFrame& frame)
{
    // Three roundings of numbers of size 1.
    EXPECT_NEAR(glm::length(glm::cross(frame.u, frame.v) - frame.n), 0, 1e-15);
    EXPECT_NEAR(glm::length(frame.u), 1, 1e-15);
    EXPECT_NEAR(glm::length(frame.v), 1, 1e-15);
}

}  // namespace

TEST(PlaneFrame, axes_stay_axes)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            Vec3 n{0.0};
            n[axis] = sign;
            const PlaneFrame frame = frame_with_normal({1, 2, 3}, n, {1, 1, 1});
            EXPECT_EQ(frame.n, n);
            EXPECT_EQ(glm::cross(frame.u, frame.v), n);
            for (const Vec3& side : {frame.u, frame.v}) EXPECT_EQ(side.x + side.y + side.z, 1.0);
        }
    }
}

TEST(PlaneFrame, tilts_of_any_size_give_orthonormal_frames)
{
    for (double tilt = 1e-15; tilt < 1; tilt *= 3) {
        const Vec3 n = glm::normalize(Vec3{tilt, -0.3 * tilt, 1});
        const PlaneFrame frame = frame_with_normal({0, 0, 0}, n, {0.3, 0.8, 0.1});
        EXPECT_NEAR(glm::length(frame.n - n), 0, 2e-12) << "only what is within 1e-12 of an axis is moved there";
        expect_orthonormal(frame);
        expect_orthonormal(turned_over(frame));
        EXPECT_NEAR(glm::length(frame.lift(frame.to_plane(frame.lift({2, 3}))) - frame.lift({2, 3})), 0, 1e-14);
    }
}
