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
        R"({"add":{"node":"crate","translation":[0,0.5,0],"geometry":{"box":{"size":[1,1,1]},"material":"oak"}}})",
        R"({"light":{"lamp":"spot","intensity_scale":0.5}})",
        R"({"light":{"lamp":"spot","intensity":[3,2,1]}})",
        R"({"light":{"name":"spot","scale":0.5}})"};
    std::vector<Edit> edits;
    for (const std::string& text : kinds) edits.push_back(edit_of(text));
    EXPECT_EQ(std::get<MoveEdit>(edits[0].what).shift.translation, Vec3(1, 0, -0.5F));
    EXPECT_EQ(std::get<LightEdit>(edits[1].what).scale, 0.25);
    EXPECT_EQ(std::get<MaterialEdit>(edits[3].what).reflectance, Rgb(0.5F));
    EXPECT_EQ(std::get<CameraEdit>(edits[4].what).camera, "side");
    EXPECT_EQ(std::get<PathEdit>(edits[6].what).from_s, 1.5);
    EXPECT_EQ(std::get<PathEdit>(edits[6].what).translation.size(), 2U);
    const auto& added = std::get<AddEdit>(edits[8].what);
    EXPECT_EQ(added.object.triangles.size(), 12U);
    for (const Vec3& position : added.object.positions) EXPECT_GE(position.y, 0) << "its place counts";
    for (const std::size_t k : {9U, 10U, 11U}) EXPECT_EQ(std::get<LightEdit>(edits[k].what).name, "spot");
    EXPECT_EQ(std::get<LightEdit>(edits[9].what).of, LightEdit::Of::lamp);
    EXPECT_EQ(std::get<LightEdit>(edits[10].what).light, Rgb(3, 2, 1));
    EXPECT_EQ(std::get<LightEdit>(edits[11].what).of, LightEdit::Of::either);
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
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"emission":1}}]})"), "request#/edits/0/light");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"lamp":"a"}}]})"), "request#/edits/0/light");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"lamp":"a","emission":1}}]})"),
              "request#/edits/0/light/emission");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"lamp":"a","intensity_scale":-1}}]})"),
              "request#/edits/0/light/intensity_scale");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"lamp":"a","material":"a","intensity":1}}]})"),
              "request#/edits/0/light/material");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"name":"a","intensity":1}}]})"),
              "request#/edits/0/light/intensity");
    EXPECT_EQ(place_of_failure(R"({"edits":[{"light":{"name":"a","scale":1e7}}]})"),
              "request#/edits/0/light/scale");
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
        EXPECT_EQ(std::get<LightEdit>(kept.what).light, emitted * static_cast<float>(scale));
    }
    world.materials[0].emission = Rgb(0);
    Edit dark = edit_of(R"({"light":{"material":")" + world.materials[0].name + R"(","emission_scale":2}})");
    EXPECT_THROW(resolve(dark, world), Error);
}

/// The small world with a spot in two places, a lamp called as its material is, and two others of one name.
World world_with_lamps() {
    World world = small_world();
    for (const auto& [name, intensity] : std::vector<std::pair<std::string, float>>{
             {"spot", 4}, {"spot", 4}, {world.materials[0].name, 1}, {"pair", 1}, {"pair", 2}, {"off", 0}}) {
        PlacedLight& placed = world.lights.emplace_back();
        placed.light.name = name;
        placed.light.intensity = Rgb(intensity);
        placed.path.keys = {{0, {}}};
    }
    return world;
}

TEST(EditJson, LampsOfANameAreScaledTogether) {
    for (const std::string form :
         {R"("lamp":"spot","intensity_scale":0.5)", R"("name":"spot","scale":0.5)"}) {
        World world = world_with_lamps();
        Edit edit = edit_of(R"({"light":{)" + form + "}}");
        resolve(edit, world);
        apply(world, edit);
        EXPECT_EQ(world.lights[0].light.intensity, Rgb(2));
        EXPECT_EQ(world.lights[1].light.intensity, Rgb(2));
        EXPECT_EQ(world.lights[2].light.intensity, Rgb(1));
        EXPECT_EQ(edit.source.dump(),
                  R"({"light":{"lamp":"spot","intensity_scale":0.5,"intensity":[2.0,2.0,2.0]}})");
        const Edit kept = edits_of_sources(sources_of({edit})).front();
        EXPECT_EQ(std::get<LightEdit>(kept.what).light, Rgb(2));
    }
}

TEST(EditJson, ANameAloneMeansAMaterialWhereNoLampHasIt) {
    World world = small_world();
    Edit edit = edit_of(R"({"light":{"name":")" + world.materials[0].name + R"(","scale":3}})");
    const Rgb emitted = world.materials[0].emission;
    resolve(edit, world);
    apply(world, edit);
    EXPECT_EQ(world.materials[0].emission, emitted * 3.0F);
}

TEST(EditJson, WhichLightIsMeantIsNotGuessed) {
    const World world = world_with_lamps();
    const std::string both = world.materials[0].name;
    const auto said = [&](const std::string& light) {
        try {
            Edit edit = edit_of(R"({"light":{)" + light + "}}");
            resolve(edit, world);
        } catch (const Error& error) {
            return error.place() + ": " + error.message();
        }
        return std::string("nothing");
    };
    EXPECT_THAT(said(R"("name":")" + both + R"(","scale":1)"),
                testing::StartsWith("name: a material that shines and a lamp"));
    EXPECT_THAT(said(R"("name":"x","scale":1)"),
                testing::EndsWith("there are: " + both + ", spot, pair, off"));
    EXPECT_THAT(said(R"("lamp":"x","intensity_scale":1)"),
                testing::EndsWith("there are: spot, " + both + ", pair, off"));
    EXPECT_THAT(said(R"("lamp":"pair","intensity_scale":1)"),
                testing::StartsWith("intensity_scale: lamps of this name"));
    EXPECT_THAT(said(R"("lamp":"off","intensity_scale":1)"),
                testing::StartsWith("intensity_scale: this lamp is off"));
    EXPECT_THAT(said(R"("name":"off","scale":1)"), testing::StartsWith("scale: this lamp is off"));
}

TEST(EditJson, LampsAreToldByName) {
    World edited = world_with_lamps();
    edited.lights[0].light.kind = Light::Kind::spot;
    set_intensity(edited, "spot", Rgb(1, 0, 0));
    const Json lamps = editable_json(edited, world_with_lamps()).at("lamps");
    ASSERT_EQ(lamps.size(), 4U);
    EXPECT_EQ(lamps[0].dump(),
              R"({"lamp":"spot","kind":"spot","intensity":[1.0,0.0,0.0],"intensity_scale":0.25})");
    EXPECT_EQ(lamps[1].at("intensity_scale"), 1);
    EXPECT_TRUE(lamps[2].at("intensity_scale").is_null()) << "of two strengths";
    EXPECT_TRUE(lamps[3].at("intensity_scale").is_null()) << "off";
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
