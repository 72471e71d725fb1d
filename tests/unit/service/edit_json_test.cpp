#include "service/jobs/edit_json.h"

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

/// The triangle that shines, and beside it one that moves.
World small_world() {
    World world = assemble(fake_scene("bytes", {}));
    Body& walker = world.bodies.emplace_back();
    walker.name = "walker";
    walker.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    walker.texture_coordinates.resize(3);
    walker.triangles = {{{0, 1, 2}, 0}};
    walker.path.keys = {{0, {Vec3(0), Quat(1, 0, 0, 0)}}, {1, {Vec3(1, 2, 3), Quat(1, 0, 0, 0)}}};
    return world;
}

Edit edit_of(const std::string& text) {
    const Json json = parse_json(text, "edit");
    return read_edit(JsonView(json, "edit"));
}

std::string place_of_failure(const std::string& text) {
    try {
        const Json json = parse_json(text, "request");
        read_edits(JsonView(json, "request"));
    } catch (const Error& error) {
        return error.place();
    }
    return "none";
}

TEST(EditJson, EveryKindIsReadAndReadsAsTheSameAgain) {
    const std::vector<std::string> kinds = {
        R"({"move":{"node":"chair","translation":[1,0,-0.5],"rotation":[0,1,0,30]}})",
        R"({"light":{"material":"lamp","emission_scale":0.25}})",
        R"({"light":{"material":"lamp","emission":[3,2,1]}})",
        R"({"material":{"material":"wall","reflectance":0.5}})",
        R"({"camera":{"camera":"side"}})",
        R"({"camera":{"position":[1,1.5,2],"look_at":[0,1,0]}})",
        R"({"path":{"node":"robot","from_s":1.5,"translation":[[0,0,0,0],[2,1,0,0]],"rotation":[[0,0,1,0,0],[2,0,1,0,720]]}})",
        R"({"remove":{"node":"rug"}})",
        R"({"add":{"node":"crate","translation":[0,0.5,0],"geometry":{"box":{"size":[1,1,1]},"material":"oak"}}})"};
    std::vector<Edit> edits;
    for (const std::string& text : kinds) edits.push_back(edit_of(text));
    EXPECT_EQ(std::get<MoveEdit>(edits[0].what).shift.translation, Vec3(1, 0, -0.5F));
    EXPECT_EQ(std::get<LightEdit>(edits[1].what).emission_scale, 0.25);
    EXPECT_EQ(std::get<MaterialEdit>(edits[3].what).reflectance, Rgb(0.5F));
    EXPECT_EQ(std::get<CameraEdit>(edits[4].what).camera, "side");
    EXPECT_EQ(std::get<PathEdit>(edits[6].what).from_s, 1.5);
    EXPECT_EQ(std::get<PathEdit>(edits[6].what).translation.size(), 2U);
    const auto& added = std::get<AddEdit>(edits[8].what);
    EXPECT_EQ(added.object.triangles.size(), 12U);
    for (const Vec3& position : added.object.positions) EXPECT_GE(position.y, 0) << "its place counts";
    const auto again = edits_of_sources(sources_of(edits));
    EXPECT_EQ(sources_of(again), sources_of(edits));
}

TEST(EditJson, WhatIsWrongIsNamedByItsPointer) {
    EXPECT_EQ(place_of_failure(R"({})"), "request");
    EXPECT_EQ(place_of_failure(R"({"edits":[]})"), "request#/edits");
    EXPECT_EQ(place_of_failure(R"({"edits":[{}]})"), "request#/edits/0");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"twist":{}}]})"), "request#/edits/0/twist");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"move":{"node":"a"}}]})"), "request#/edits/0/move");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"remove":{"node":"a"}},{"move":{"translation":[0,0,1]}}]})"),
              "request#/edits/1/move");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"move":{"node":"a","translation":[0,0]}}]})"),
              "request#/edits/0/move/translation");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"move":{"node":"a","translation":[0,0,1e9]}}]})"),
              "request#/edits/0/move/translation");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"material":"a","emission_scale":-1}}]})"),
              "request#/edits/0/light/emission_scale");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"material":{"material":"a","reflectance":[1,0,0]}}]})"),
              "request#/edits/0/material/reflectance");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"camera":{"position":[0,0,0]}}]})"), "request#/edits/0/camera");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"camera":{"position":[0,0,0],"look_at":[0,0,0]}}]})"),
              "request#/edits/0/camera/look_at");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"path":{"node":"a","translation":[[1,0,0,0],[0,0,0,0]]}}]})"),
              "request#/edits/0/path/translation/1");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"add":{"node":"a","geometry":{"file":"x.obj"}}}]})"),
              "request#/edits/0/add/geometry");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"material":"a","emission":1,"colour":2}}]})"),
              "request#/edits/0/light/colour");
}

TEST(EditJson, ALampIsScaledFromWhatItIsInTheScene) {
    World world = small_world();
    const std::string lamp = world.materials[0].name;
    const Rgb emitted = world.materials[0].emission;
    for (const double scale : {0.5, 0.0, 2.0}) {
        Edit edit = edit_of(R"({"light":{"material":")" + lamp + R"(","emission_scale":)" +
                            std::to_string(scale) + "}}");
        resolve(edit, small_world());
        apply(world, edit);
        EXPECT_EQ(world.materials[0].emission, emitted * static_cast<float>(scale)) << "also after 0";
        // What is kept needs the scene no more.
        const Edit kept = edits_of_sources(sources_of({edit})).front();
        EXPECT_EQ(std::get<LightEdit>(kept.what).emission, emitted * static_cast<float>(scale));
    }
    world.materials[0].emission = Rgb(0);
    Edit dark = edit_of(R"({"light":{"material":")" + world.materials[0].name + R"(","emission_scale":2}})");
    EXPECT_THROW(resolve(dark, world), Error);
}

TEST(EditJson, AnActorIsMovedAlongAllOfItsPath) {
    World world = small_world();
    const Path before = world.bodies[1].path;
    apply(world, edit_of(R"({"move":{"node":")" + world.bodies[1].name + R"(","translation":[0,0.25,0]}})"));
    for (const double time : {0.0, 0.3, 1.0, 5.0})
        EXPECT_LE(glm::length(world.bodies[1].path.at(time).translation - before.at(time).translation -
                              Vec3(0, 0.25F, 0)),
                  1e-6F);
}

TEST(EditJson, APathFromATimeOnChangesFramesFromThereOnly) {
    const Edit path = edit_of(R"({"path":{"node":"a","from_s":1.0,"translation":[[0,0,0,0]]}})");
    EXPECT_EQ(first_frame_changed(path, 0, 24), 24);
    EXPECT_EQ(first_frame_changed(path, 30, 24), 30);
    EXPECT_EQ(first_frame_changed(path, 0, 10), 10);
    EXPECT_EQ(first_frame_changed(edit_of(R"({"remove":{"node":"a"}})"), 3, 24), 3);
}

TEST(EditJson, TheCameraIsTheScenesUnlessAPlaceIsGiven) {
    const World world = small_world();
    const auto camera = [&](const std::string& text) {
        return camera_of(world, "", std::get<CameraEdit>(edit_of(text).what));
    };
    const PlacedCamera placed = camera(R"({"camera":{"position":[1,1,1],"look_at":[1,1,0]}})");
    EXPECT_EQ(placed.path.keys.size(), 1U);
    EXPECT_EQ(placed.path.at(0).translation, Vec3(1));
    EXPECT_LE(glm::length(placed.path.at(0).direction(Vec3(0, 0, -1)) - Vec3(0, 0, -1)), 1e-6F);
    EXPECT_THROW(camera(R"({"camera":{"camera":"no such"}})"), Error);
    EXPECT_EQ(camera(R"({"camera":{"camera":")" + world.cameras[0].camera.name + R"("}})").path.at(0),
              world.cameras[0].path.at(0));
}

}  // namespace
}  // namespace afterglow
