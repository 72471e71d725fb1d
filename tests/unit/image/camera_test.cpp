#include "solver/image/camera.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

TEST(Camera, LooksAlongMinusZWithTheVerticalAngleFromTopToBottom) {
    PlacedCamera camera = testing::empty_world(0.5F, Vec3(1, 2, 3)).cameras[0];
    camera.camera.vertical_angle = 1;
    const CameraView view = view_at(camera, 0, 200, 100);
    EXPECT_EQ(view.ray(100, 50).origin, Vec3(1, 2, 3));
    EXPECT_NEAR(glm::length(view.ray(100, 50).direction - Vec3(0, 0, -1)), 0, 1e-6);
    const Vec3 top = view.ray(100, 0).direction;
    EXPECT_NEAR(std::atan2(top.y, -top.z), 0.5, 1e-6);
    const Vec3 right = view.ray(200, 50).direction;
    EXPECT_NEAR(right.x / -right.z, 2 * std::tan(0.5), 1e-5);
}

}  // namespace
}  // namespace afterglow
