#include <cmath>

#include <gmock/gmock.h>

#include "solver/scene/area.h"
#include "solver/scene/world.h"

namespace afterglow {
namespace {

/// A scene with one triangle in the xy plane facing +z, and a camera, and whatever nodes a test adds.
struct Builder {
    Scene scene;

    Builder() {
        scene.materials.resize(1);
        scene.materials[0].emission = Rgb(1);
        scene.meshes.push_back(
            {"triangle", {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}, {Triangle{{0, 1, 2}, 0}}});
        scene.cameras.push_back({"camera", 0.7F});
        scene.duration_s = 2;
        Node camera;
        camera.name = "camera";
        camera.camera = 0;
        scene.nodes.push_back(camera);
    }
    Index add(const std::string& name, Index parent, const Transform& local, Index mesh = no_index) {
        Node node;
        node.name = name;
        node.parent = parent;
        node.local = local;
        node.mesh = mesh;
        scene.nodes.push_back(node);
        return static_cast<Index>(scene.nodes.size() - 1);
    }
    void slide(Index node, const Vec3& from, const Vec3& to) {
        scene.tracks.node_translation.push_back({node, {{0, from}, {2, to}}});
    }
    void turn(Index node, float angle, const Vec3& axis = Vec3(0, 1, 0)) {
        scene.tracks.node_rotation.push_back(
            {node, {{0, Quat(1, 0, 0, 0)}, {2, glm::angleAxis(angle, axis)}}});
    }
};

Transform at(const Vec3& translation, const Vec3& scale = Vec3(1)) {
    return {translation, Quat(1, 0, 0, 0), scale};
}

/// Where the node's point is at a time by plain matrices: the oracle for assembled paths.
Vec3 world_point(const Scene& scene, Index node, const Vec3& point, double time_s) {
    glm::vec4 p(point, 1);
    for (Index n = node; n != no_index; n = scene.nodes[n].parent) {
        Transform local = scene.nodes[n].local;
        for (const auto& track : scene.tracks.node_translation)
            if (track.target == n) local.translation = value_at(track, time_s);
        for (const auto& track : scene.tracks.node_rotation)
            if (track.target == n) local.rotation = value_at(track, time_s);
        p = local.matrix() * p;
    }
    return Vec3(p);
}

/// At every frame the body's triangles are where the node's are. Frames are where sampled paths have keys.
void expect_follows(const World& world, const Body& body, const Scene& scene, Index node) {
    const auto& mesh = scene.meshes[scene.nodes[node].mesh];
    for (int frame = 0; frame <= 48; ++frame) {
        const double time = frame / world.frames_per_second;
        const Pose pose = body.path.at(time);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3 expected = world_point(scene, node, mesh.positions[v], time);
            // Two keys' tolerances: position 1e-4 m, and 1e-4 rad on arms of at most 10 m.
            EXPECT_LT(glm::length(pose.point(body.positions[v]) - expected), 1.2e-3F) << frame;
        }
    }
}

TEST(Assemble, JoinsStaticNodesInWorldCoordinates) {
    Builder b;
    const Index table = b.add("table", no_index, at(Vec3(1, 0, 0), Vec3(2)));
    b.add("top", table, at(Vec3(0, 3, 0)), 0);
    b.add("other", no_index, at(Vec3(0, 0, 9)), 0);
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 1U);
    const Body& body = world.bodies[furniture];
    EXPECT_FALSE(body.path.moves());
    ASSERT_EQ(body.triangles.size(), 2U);
    EXPECT_EQ(body.positions[1], Vec3(3, 6, 0));
    EXPECT_EQ(body.positions[body.triangles[1].vertices[0]], Vec3(0, 0, 9));
    EXPECT_EQ(body.texture_coordinates.size(), body.positions.size());
}

TEST(Assemble, KeepsFrontsInFrontUnderMirroring) {
    Builder b;
    b.add("mirrored", no_index, at(Vec3(0), Vec3(-1, 1, 1)), 0);
    const World world = assemble(b.scene);
    const Body& body = world.bodies[furniture];
    const auto& [i, j, k] = body.triangles.at(0).vertices;
    const Vec3 normal =
        glm::cross(body.positions[j] - body.positions[i], body.positions[k] - body.positions[i]);
    EXPECT_GT(normal.z, 0) << "the mirrored triangle still faces +z";
}

TEST(Assemble, MakesAnActorOfAMovingNodeAndWhatHangsOnIt) {
    Builder b;
    const Index cart = b.add("cart", no_index, at(Vec3(5, 0, 0)), 0);
    const Index load = b.add("load", cart, at(Vec3(0, 1, 0), Vec3(0.5F)), 0);
    b.slide(cart, Vec3(5, 0, 0), Vec3(7, 0, 0));
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 2U);
    EXPECT_TRUE(world.bodies[furniture].triangles.empty());
    const Body& actor = world.bodies[1];
    EXPECT_EQ(actor.name, "cart");
    EXPECT_EQ(actor.triangles.size(), 2U);
    EXPECT_EQ(actor.path.keys.size(), 2U);
    EXPECT_EQ(actor.path.at(1).translation, Vec3(6, 0, 0));
    EXPECT_EQ(actor.positions[0], Vec3(0)) << "actor geometry stands in its own frame";
    EXPECT_EQ(actor.positions[4], Vec3(0.5F, 1, 0)) << "with scale baked";
    expect_follows(world, actor, b.scene, cart);
    static_cast<void>(load);
}

TEST(Assemble, TreatsTracksThatNeverMoveAsFurniture) {
    Builder b;
    const Index node = b.add("still", no_index, at(Vec3(9)), 0);
    b.slide(node, Vec3(1, 2, 3), Vec3(1, 2, 3.00001F));
    b.turn(node, 0);
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 1U);
    EXPECT_EQ(world.bodies[0].positions[0], Vec3(1, 2, 3)) << "the track's value, not the node's own";
}

TEST(Assemble, SplitsNestedMovingNodesIntoActors) {
    Builder b;
    const Index arm = b.add("arm", no_index, at(Vec3(0, 1, 0)), 0);
    const Index hand = b.add("hand", arm, at(Vec3(2, 0, 0), Vec3(0.3F)), 0);
    b.turn(arm, 2.0F);
    b.turn(hand, -3.0F, Vec3(1, 0, 0));
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 3U);
    EXPECT_EQ(world.bodies[2].name, "hand");
    EXPECT_EQ(world.bodies[1].path.keys.size(), 2U) << "a plain turn needs no samples";
    EXPECT_GT(world.bodies[2].path.keys.size(), 10U) << "an arc does";
    expect_follows(world, world.bodies[1], b.scene, arm);
    expect_follows(world, world.bodies[2], b.scene, hand);
}

TEST(Assemble, GivesTheMovingAncestorsOfAMeshNoBodyOfTheirOwn) {
    Builder b;
    const Index rig = b.add("rig", no_index, at(Vec3(0)));
    const Index mesh = b.add("mesh", rig, at(Vec3(1, 0, 0)), 0);
    b.slide(rig, Vec3(0), Vec3(0, 0, 4));
    const World carried = assemble(b.scene);
    ASSERT_EQ(carried.bodies.size(), 2U);
    EXPECT_EQ(carried.bodies[1].name, "rig");

    b.slide(mesh, Vec3(1, 0, 0), Vec3(1, 2, 0));
    const World both = assemble(b.scene);
    ASSERT_EQ(both.bodies.size(), 2U) << "all of rig's geometry belongs to the mesh node now";
    EXPECT_EQ(both.bodies[1].name, "mesh");
    EXPECT_EQ(both.bodies[1].path.keys.size(), 2U) << "two straight motions at one pace are one";
    expect_follows(both, both.bodies[1], b.scene, mesh);
}

TEST(Assemble, JoinsKeyTimesAndKeepsJumps) {
    Builder b;
    const Index parent = b.add("parent", no_index, at(Vec3(0)));
    const Index child = b.add("child", parent, at(Vec3(0)), 0);
    b.scene.tracks.node_translation.push_back({parent, {{0, Vec3(0)}, {1, Vec3(1, 0, 0)}, {2, Vec3(0)}}});
    b.scene.tracks.node_translation.push_back(
        {child, {{0, Vec3(0)}, {0.5, Vec3(0)}, {0.5, Vec3(0, 5, 0)}, {2, Vec3(0, 5, 0)}}});
    const World world = assemble(b.scene);
    const auto& keys = world.bodies.at(1).path.keys;
    std::vector<double> times;
    for (const auto& key : keys) times.push_back(key.time_s);
    EXPECT_THAT(times, testing::ElementsAre(0, 0.5, 0.5, 1, 2));
    EXPECT_EQ(keys[1].value.translation, Vec3(0.5F, 0, 0));
    EXPECT_EQ(keys[2].value.translation, Vec3(0.5F, 5, 0));
}

TEST(Assemble, AllowsUnevenScaleThatDoesNotDeform) {
    Builder b;
    const Index top = b.add("top", no_index, at(Vec3(0)));
    const Index stretched = b.add("stretched", top, at(Vec3(0), Vec3(1, 2, 3)));
    const Index inner =
        b.add("inner", stretched, {Vec3(1, 0, 0), glm::angleAxis(0.5F, Vec3(1, 0, 0)), Vec3(1)}, 0);
    b.turn(top, 2.5F);
    b.slide(inner, Vec3(0), Vec3(1, 1, 1));
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 2U);
    expect_follows(world, world.bodies[1], b.scene, inner);
}

TEST(Assemble, TurnsInsideAMirrorTheOtherWay) {
    Builder b;
    const Index mirror = b.add("mirror", no_index, at(Vec3(0), Vec3(-1, 1, 1)));
    const Index inner = b.add("inner", mirror, at(Vec3(2, 0, 0)), 0);
    b.turn(inner, 1.5F);
    const World world = assemble(b.scene);
    ASSERT_EQ(world.bodies.size(), 2U);
    const Body& body = world.bodies[1];
    const auto& [i, j, k] = body.triangles.at(0).vertices;
    EXPECT_GT(glm::cross(body.positions[j] - body.positions[i], body.positions[k] - body.positions[i]).z, 0);
    expect_follows(world, body, b.scene, inner);
}

TEST(Assemble, RejectsAShapeThatChangesAsItTurns) {
    Builder b;
    const Index stretched = b.add("stretched", no_index, at(Vec3(0), Vec3(1, 2, 1)));
    const Index wheel = b.add("wheel", stretched, at(Vec3(0)), 0);
    b.turn(wheel, 1.0F, Vec3(0, 0, 1));
    try {
        assemble(b.scene);
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::unsupported);
        EXPECT_EQ(e.place(), R"(node "wheel")");
    }
}

TEST(Assemble, LeavesOutWhatAScaleOfZeroHides) {
    Builder b;
    const Index hidden = b.add("hidden", no_index, at(Vec3(1), Vec3(0)), 0);
    b.slide(hidden, Vec3(0), Vec3(1));
    b.add("flat", no_index, at(Vec3(1), Vec3(1, 0, 1)), 0);
    const World world = assemble(b.scene);
    EXPECT_EQ(world.bodies.size(), 1U);
    EXPECT_TRUE(world.bodies[0].triangles.empty());
    EXPECT_THAT(world.warnings, testing::SizeIs(2));
}

TEST(Assemble, PlacesCamerasAndLightsOnPaths) {
    Builder b;
    const Index dolly = b.add("dolly", no_index, at(Vec3(0, 2, 0)));
    b.scene.nodes[dolly].camera = 0;
    const Index lamp = b.add("lamp", dolly, at(Vec3(0, 0, -1)));
    b.scene.lights.push_back({});
    b.scene.nodes[lamp].light = 0;
    b.slide(dolly, Vec3(0, 2, 0), Vec3(0, 2, 6));
    const World world = assemble(b.scene);
    ASSERT_EQ(world.cameras.size(), 2U);
    EXPECT_EQ(world.cameras[0].path.keys.size(), 1U);
    EXPECT_EQ(world.cameras[1].path.at(1).translation, Vec3(0, 2, 3));
    ASSERT_EQ(world.lights.size(), 1U);
    EXPECT_EQ(world.lights[0].path.at(2).translation, Vec3(0, 2, 5));
    EXPECT_EQ(world.bodies.size(), 1U) << "neither is an actor";
}

TEST(Assemble, AimsACameraUnderAMirrorAlongItsImage) {
    Builder b;
    const Index mirror = b.add("mirror", no_index, at(Vec3(0), Vec3(1, 1, -1)));
    const Index camera = b.add("inner", mirror, at(Vec3(0)));
    b.scene.nodes[camera].camera = 0;
    const Pose pose = assemble(b.scene).cameras.at(1).path.at(0);
    EXPECT_LT(glm::length(pose.direction(Vec3(0, 0, -1)) - Vec3(0, 0, 1)), 1e-6F);
    EXPECT_LT(glm::length(pose.direction(Vec3(0, 1, 0)) - Vec3(0, 1, 0)), 1e-6F);
}

TEST(Assemble, RejectsNestedTurnsThatNeedEndlessKeys) {
    Builder b;
    Index parent = no_index;
    for (int level = 0; level < 20; ++level) {
        parent = b.add("joint", parent, at(Vec3(1, 0, 0)));
        b.scene.tracks.node_rotation.push_back(
            {parent, {{0, Quat(1, 0, 0, 0)}, {40'000, glm::angleAxis(1.0F, Vec3(0, 1, 0))}}});
    }
    b.scene.nodes.back().mesh = 0;
    EXPECT_THROW(assemble(b.scene), Error);
}

TEST(Assemble, RejectsCoordinatesThatScaleMakesHuge) {
    Builder b;
    b.add("huge", no_index, at(Vec3(0), Vec3(1e30F)), 0);
    EXPECT_THROW(assemble(b.scene), Error);
}

}  // namespace
}  // namespace afterglow
