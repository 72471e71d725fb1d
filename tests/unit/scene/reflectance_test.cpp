#include "solver/scene/reflectance.h"

#include <gmock/gmock.h>

#include "solver/scene/load.h"
#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

TEST(LimitReflectance, RejectsFullReflectionInAClosedScene) {
    for (const float reflectance : {1.0F, 1.5F}) {
        Scene scene = room_scene();
        scene.materials[0].reflectance.g = reflectance;
        try {
            validate(scene);
            FAIL() << "accepted";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::cannot_converge);
            EXPECT_EQ(e.place(), R"(material "wall")");
        }
    }
}

TEST(LimitReflectance, TakesItAsAlmostFullWhereLightCanLeave) {
    Scene scene = open_scene();
    scene.materials[0].reflectance = Rgb(1.0F, 0.3F, 7.0F);
    validate(scene);
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.99F, 0.3F, 0.99F));
    ASSERT_THAT(scene.warnings, testing::SizeIs(1));
    EXPECT_EQ(scene.warnings[0].place, R"(material "wall")");
}

TEST(LimitReflectance, LeavesWhatIsJustBelowOne) {
    Scene scene = room_scene();
    scene.materials[0].reflectance = Rgb(0.9999F);
    validate(scene);
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.9999F));
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
}

TEST(LimitReflectance, JudgesTracksLikeMaterials) {
    Scene closed = room_scene();
    closed.tracks.material_reflectance.push_back({0, {{0, Rgb(0.5F)}, {1, Rgb(1)}}});
    EXPECT_THROW(validate(closed), Error);
    Scene open = open_scene();
    open.tracks = closed.tracks;
    validate(open);
    EXPECT_EQ(open.tracks.material_reflectance[0].keys[1].value, Rgb(0.99F));
}

TEST(LimitReflectance, TrustsATextureToAbsorb) {
    Scene scene = room_scene();
    scene.textures.push_back({"plaster", 1, 1, {128, 128, 128, 255}});
    scene.materials[0].texture = 0;
    scene.materials[0].reflectance = Rgb(1);
    validate(scene);
    EXPECT_EQ(scene.materials[0].reflectance, Rgb(0.99F));
}

TEST(LimitReflectance, DoesNotRejectForAMaterialThatNothingIsMadeOf) {
    Scene scene = room_scene();
    scene.materials.resize(3);
    scene.materials[2].reflectance = Rgb(1);
    validate(scene);
    EXPECT_EQ(scene.materials[2].reflectance, Rgb(0.99F));
    EXPECT_EQ(scene.warnings.at(0).place, "material 2");
}

TEST(LimitReflectance, NamesAFewOfManyMaterials) {
    Scene scene = open_scene();
    scene.materials.resize(10);
    for (auto& material : scene.materials) material.reflectance = Rgb(1);
    validate(scene);
    ASSERT_THAT(scene.warnings, testing::SizeIs(1));
    EXPECT_THAT(scene.warnings[0].place, testing::HasSubstr("and 5 more"));
}

}  // namespace
}  // namespace afterglow
