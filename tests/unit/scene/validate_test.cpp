#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "solver/scene/load.h"
#include "solver/scene/world.h"
#include "tests/unit/scene/test_scenes.h"

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// What validate says about a scene, with the kind it must be of.
std::string refusal(Scene scene, ErrorKind kind = ErrorKind::invalid_input) {
    try {
        validate(scene);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.what();
        return e.what();
    }
    return "accepted";
}

TEST(Validate, LeavesAGoodSceneAlone) {
    Scene scene = room_scene();
    validate(scene);
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
    EXPECT_EQ(scene.meshes[0].triangles.size(), 12U);
    EXPECT_EQ(scene.nodes.size(), 2U);
}

TEST(Validate, NamesMeshAndVertexOfWhatIsNotFinite) {
    for (const float bad : {nan, infinity, -infinity}) {
        Scene scene = room_scene();
        scene.meshes[0].positions[5].y = bad;
        EXPECT_THAT(refusal(scene), HasSubstr(R"(mesh "box", vertex 5)"));
    }
    Scene scene = room_scene();
    scene.meshes[0].positions[5].y = 1e20F;
    EXPECT_THAT(refusal(scene), HasSubstr("check the units"));
}

TEST(Validate, DropsTrianglesWithoutAreaInOneWarning) {
    Scene scene = room_scene();
    auto& mesh = scene.meshes[0];
    mesh.triangles.push_back({{0, 0, 1}, 0});
    mesh.positions.emplace_back(0, -1, -1);
    mesh.triangles.push_back({{0, 8, 1}, 0});  // three points on a line
    validate(scene);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    ASSERT_THAT(scene.warnings, testing::SizeIs(1));
    EXPECT_THAT(scene.warnings[0].message, HasSubstr("2 triangles"));
    EXPECT_EQ(scene.warnings[0].place, R"(mesh "box")");
}

TEST(Validate, KeepsTinyTriangles) {
    Scene scene = room_scene();
    scene.nodes[0].local.scale = Vec3(1e-6F);
    for (auto& p : scene.meshes[0].positions) p *= 1e-12F;
    validate(scene);
    EXPECT_EQ(scene.meshes[0].triangles.size(), 12U);
}

TEST(Validate, RejectsIndicesOutOfRange) {
    const auto broken = [](auto change) {
        Scene scene = room_scene();
        change(scene);
        return refusal(scene);
    };
    EXPECT_THAT(broken([](Scene& s) { s.meshes[0].triangles[3].vertices[1] = 8; }),
                AllOf(HasSubstr(R"(mesh "box", triangle 3)"), HasSubstr("vertex 8")));
    EXPECT_THAT(broken([](Scene& s) { s.meshes[0].triangles[3].material = 2; }), HasSubstr("material 2"));
    EXPECT_THAT(broken([](Scene& s) { s.nodes[0].mesh = 1; }), HasSubstr(R"(node "room": mesh 1)"));
    EXPECT_THAT(broken([](Scene& s) { s.nodes[0].camera = 7; }), HasSubstr("camera 7"));
    EXPECT_THAT(broken([](Scene& s) { s.nodes[0].light = 0; }), HasSubstr("light 0"));
    EXPECT_THAT(broken([](Scene& s) { s.materials[0].texture = 0; }), HasSubstr("texture 0"));
    EXPECT_THAT(broken([](Scene& s) {
                    s.tracks.node_translation.push_back({9, {{0, Vec3(0)}}});
                }),
                HasSubstr("target 9"));
}

TEST(Validate, RejectsAHierarchyThatMayBeRecursive) {
    Scene scene = room_scene();
    scene.nodes[0].parent = 1;
    EXPECT_THAT(refusal(scene), HasSubstr("recursive"));
    scene.nodes[0].parent = 0;
    EXPECT_THAT(refusal(scene), HasSubstr("recursive"));
}

TEST(Validate, RejectsTransformsThatAreNone) {
    Scene scene = room_scene();
    scene.nodes[0].local.rotation = Quat(0, 0, 0, 0);
    EXPECT_THAT(refusal(scene), HasSubstr("quaternion"));
    scene = room_scene();
    scene.nodes[1].local.scale.x = nan;
    EXPECT_THAT(refusal(scene), HasSubstr(R"(node "camera")"));
}

TEST(Validate, RejectsNegativeReflectanceAndEmission) {
    Scene scene = open_scene();
    scene.materials[0].reflectance.g = -0.1F;
    EXPECT_THAT(refusal(scene), AllOf(HasSubstr(R"(material "wall")"), HasSubstr("reflectance")));
    scene = open_scene();
    scene.materials[1].emission.b = -1;
    EXPECT_THAT(refusal(scene), AllOf(HasSubstr(R"(material "lamp")"), HasSubstr("emission")));
    scene.materials[1].emission.b = infinity;
    EXPECT_THAT(refusal(scene), HasSubstr("emission"));
}

TEST(Validate, RejectsASceneInWhichNothingShines) {
    Scene dark = room_scene();
    dark.materials[1].emission = Rgb(0);
    EXPECT_THAT(refusal(dark), HasSubstr("area lamps"));

    Scene switched_off = room_scene();
    switched_off.tracks.material_emission.push_back({1, {{0, 0.0F}, {1, 0.0F}}});
    EXPECT_THAT(refusal(switched_off), HasSubstr("nothing in it shines"));

    Scene unused = room_scene();
    for (auto& triangle : unused.meshes[0].triangles) triangle.material = 0;
    EXPECT_THAT(refusal(unused), HasSubstr("nothing in it shines"));

    Scene unplaced = dark;
    unplaced.lights.push_back({"spare", Light::Kind::point, Rgb(5), 0, 1});
    EXPECT_THAT(refusal(unplaced), HasSubstr("nothing in it shines"));
}

TEST(Validate, AcceptsAnyKindOfLight) {
    Scene dark = room_scene();
    dark.materials[1].emission = Rgb(0);
    Scene sky = dark;
    sky.background = Rgb(1);
    EXPECT_NO_THROW(validate(sky));
    Scene point = dark;
    point.lights.push_back({"bulb", Light::Kind::point, Rgb(5), 0, 1});
    point.nodes[1].light = 0;
    EXPECT_NO_THROW(validate(point));
}

TEST(Validate, PlacesADefaultCameraThatSeesTheScene) {
    for (Scene scene : {room_scene(), open_scene()}) {
        scene.nodes.pop_back();
        scene.cameras.clear();
        scene.nodes[0].local.translation = Vec3(100, 0, 0);
        const bool is_closed = scene.meshes[0].triangles.size() == 12;
        validate(scene);
        ASSERT_THAT(scene.warnings, testing::SizeIs(1));
        EXPECT_EQ(scene.warnings[0].place, "camera");
        const World world = assemble(scene);
        ASSERT_EQ(world.cameras.size(), 1U);
        const Pose pose = world.cameras[0].path.at(0);
        const Vec3 to_centre = Vec3(100, 0, 0) - pose.translation;
        EXPECT_LT(glm::length(glm::normalize(to_centre) - pose.direction(Vec3(0, 0, -1))), 1e-5F);
        const Vec3 offset = glm::abs(to_centre);
        EXPECT_EQ(max_channel(offset) < 1, is_closed) << "inside a closed room, outside an open one";
    }
}

TEST(Validate, RejectsAnEmptyScene) {
    Scene scene;
    scene.background = Rgb(1);
    EXPECT_THAT(refusal(scene), HasSubstr("no triangles"));
    Scene flat = room_scene();
    for (auto& p : flat.meshes[0].positions) p = Vec3(1);
    EXPECT_THAT(refusal(flat), HasSubstr("no triangles"));
}

TEST(Validate, CountsInstancesAgainstTheTriangleLimit) {
    Scene scene = room_scene();
    Node copy = scene.nodes[0];
    // 12 triangles × 4.2 million nodes; the counts of one mesh or of the nodes alone would pass.
    scene.nodes.resize(4'200'000, copy);
    EXPECT_THAT(refusal(scene, ErrorKind::too_large), HasSubstr("50 million"));
}

TEST(Validate, ChecksTextures) {
    Scene scene = room_scene();
    scene.textures.push_back({"brick", 2, 2, std::vector<std::uint8_t>(15)});
    EXPECT_THAT(refusal(scene), HasSubstr(R"(texture "brick")"));
    scene = room_scene();
    scene.meshes[0].texture_coordinates.resize(3);
    EXPECT_THAT(refusal(scene), HasSubstr("texture coordinates"));
}

TEST(Validate, ChecksCamerasAndLights) {
    for (const float angle : {0.0F, -1.0F, 3.2F, nan}) {
        Scene scene = room_scene();
        scene.cameras[0].vertical_angle = angle;
        EXPECT_THAT(refusal(scene), HasSubstr(R"(camera "camera")"));
    }
    Scene scene = room_scene();
    scene.lights.push_back({"spot", Light::Kind::spot, Rgb(1), 1.0F, 0.5F});
    EXPECT_THAT(refusal(scene), HasSubstr("cone"));
}

TEST(Validate, TwoElementsMayHaveOneName) {
    Scene scene = room_scene();
    scene.nodes[1].name = "room";
    scene.materials[1].name = "wall";
    scene.cameras.push_back(scene.cameras[0]);
    EXPECT_NO_THROW(validate(scene));
}

TEST(Validate, ExtendsTheDurationToTheLastKey) {
    Scene scene = room_scene();
    scene.duration_s = 1;
    scene.tracks.node_translation.push_back({0, {{0, Vec3(0)}, {3.5, Vec3(1)}}});
    validate(scene);
    EXPECT_EQ(scene.duration_s, 3.5);
}

}  // namespace
}  // namespace afterglow
