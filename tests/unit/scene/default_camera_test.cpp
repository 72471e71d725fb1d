#include "solver/scene/default_camera.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

TEST(LookingAt, PointsMinusZAtItsTargetWithYUp) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int k = 0; k < 500; ++k) {
        const Vec3 from(normal(random), normal(random), normal(random));
        const Vec3 to(normal(random), normal(random), normal(random));
        const Quat rotation = looking_at(from, to);
        EXPECT_LT(glm::length(rotation * Vec3(0, 0, -1) - glm::normalize(to - from)), 1e-5F);
        EXPECT_NEAR((rotation * Vec3(1, 0, 0)).y, 0, 1e-5F) << "the horizon is level";
        EXPECT_GE((rotation * Vec3(0, 1, 0)).y, 0);
    }
}

TEST(LookingAt, FindsAnAxisWhereUpIsAlongTheView) {
    const Quat rotation = looking_at(Vec3(0, 5, 0), Vec3(0));
    EXPECT_LT(glm::length(rotation * Vec3(0, 0, -1) - Vec3(0, -1, 0)), 1e-5F);
    EXPECT_NEAR(glm::length(rotation), 1, 1e-5F);
}

TEST(AddDefaultCamera, SeesEveryCornerOfAnOpenScene) {
    Scene scene = open_scene();
    add_default_camera(scene, assemble(scene));
    const World world = assemble(scene);
    const PlacedCamera& placed = world.cameras.back();
    const Pose pose = placed.path.at(0);
    for (const Vec3& corner : scene.meshes[0].positions) {
        const Vec3 seen = glm::inverse(pose.rotation) * (corner - pose.translation);
        EXPECT_LT(seen.z, 0);
        EXPECT_LT(std::abs(seen.y / seen.z), std::tan(placed.camera.vertical_angle / 2));
        EXPECT_LT(std::abs(seen.x / seen.z), std::tan(placed.camera.vertical_angle / 2));
    }
}

}  // namespace
}  // namespace afterglow
