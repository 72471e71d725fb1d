#include <gmock/gmock.h>

#include "solver/scene/world.h"

namespace afterglow {
namespace {

TEST(Path, WithoutKeysNeverMoves) {
    const Path path;
    EXPECT_EQ(path.at(3.0), Pose{});
    EXPECT_FALSE(path.moves());
}

TEST(Path, InterpolatesPositionAndRotationTogether) {
    const Quat half_turn = glm::angleAxis(pi * 0.999F, Vec3(0, 1, 0));
    const Path path{{{0.0, {}}, {2.0, {Vec3(4, 0, 0), half_turn}}}};
    const Pose middle = path.at(1.0);
    EXPECT_EQ(middle.translation, Vec3(2, 0, 0));
    EXPECT_NEAR(glm::angle(middle.rotation), pi * 0.4995F, 1e-5F);
    EXPECT_EQ(path.at(5.0), path.keys.back().value);
    EXPECT_TRUE(path.moves());
}

TEST(Pose, MatrixAgreesWithPointAndDirection) {
    const Pose pose{Vec3(1, 2, 3), glm::angleAxis(0.7F, glm::normalize(Vec3(1, 1, 0)))};
    const Vec3 p(0.3F, -0.2F, 5);
    const Vec3 through_matrix(pose.matrix() * glm::vec4(p, 1));
    EXPECT_LT(glm::length(through_matrix - pose.point(p)), 1e-5F);
    EXPECT_LT(glm::length(pose.point(p) - pose.direction(p) - pose.translation), 1e-5F);
}

TEST(MaterialAt, AppliesItsOwnTracksOnly) {
    World world;
    world.materials.resize(2);
    world.materials[0].emission = Rgb(2, 4, 6);
    world.materials[1].emission = Rgb(1);
    world.material_emission.push_back({0, {{0.0, 0.0F}, {1.0, 1.0F}}});
    world.material_reflectance.push_back({1, {{0.0, Rgb(0.1F)}, {1.0, Rgb(0.3F)}}});
    EXPECT_EQ(material_at(world, 0, 0.5).emission, Rgb(1, 2, 3));
    EXPECT_EQ(material_at(world, 0, 0.5).reflectance, world.materials[0].reflectance);
    EXPECT_EQ(material_at(world, 1, 0.5).emission, Rgb(1));
    EXPECT_NEAR(material_at(world, 1, 0.5).reflectance.g, 0.2F, 1e-6F);
}

}  // namespace
}  // namespace afterglow
