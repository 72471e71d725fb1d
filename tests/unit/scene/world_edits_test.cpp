#include "solver/scene/world_edits.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>

#include "solver/scene/furniture.h"

namespace afterglow {
namespace {

Quat about_y(float degrees) {
    return glm::angleAxis(glm::radians(degrees), Vec3(0, 1, 0));
}

TEST(WorldEdits, KeysOfPositionsAndRotationsMakeOnePath) {
    const std::vector<Key<Vec3>> places = {{0, Vec3(0)}, {2, Vec3(2, 0, 0)}, {2, Vec3(5, 0, 0)}};
    const std::vector<Key<Quat>> turns = {{1, about_y(0)}, {3, about_y(90)}};
    const Path path = with_keys({}, places, turns);
    for (const double time : {0.0, 0.5, 1.0, 1.7, 2.0, 2.5, 3.0, 4.0}) {
        const Vec3 place = time < 2 ? Vec3(static_cast<float>(time), 0, 0) : Vec3(5, 0, 0);
        const auto turned = static_cast<float>(std::clamp(time - 1, 0.0, 2.0) * 45);
        EXPECT_LE(glm::length(path.at(time).translation - place), 1e-5F) << time;
        EXPECT_GE(std::abs(glm::dot(path.at(time).rotation, about_y(turned))), 1 - 1e-5F) << time;
    }
    EXPECT_LE(glm::length(path.at(2 - 1e-9).translation - Vec3(2, 0, 0)), 1e-4F) << "the jump stays one";
}

TEST(WorldEdits, WhatHasNoKeysGoesOnAsBefore) {
    Path old;
    old.keys = {{0, {Vec3(0), about_y(0)}}, {1, {Vec3(1), about_y(80)}}};
    const Path moved = with_keys(old, {{0, Vec3(7)}}, {});
    const Path turned = with_keys(old, {}, {{0, about_y(10)}});
    for (const double time : {0.0, 0.25, 0.9, 2.0}) {
        EXPECT_EQ(moved.at(time).translation, Vec3(7));
        EXPECT_GE(std::abs(glm::dot(moved.at(time).rotation, old.at(time).rotation)), 1 - 1e-6F);
        EXPECT_LE(glm::length(turned.at(time).translation - old.at(time).translation), 1e-6F);
    }
}

TEST(WorldEdits, AllLampsOfANameGetOneIntensity) {
    World world;
    for (const std::string name : {"spot", "bulb", "spot"}) world.lights.emplace_back().light.name = name;
    EXPECT_EQ(lamps_named(world, "spot"), (std::vector<Index>{0, 2}));
    EXPECT_EQ(set_intensity(world, "spot", Rgb(3, 2, 1)), 0U);
    EXPECT_EQ(world.lights[0].light.intensity, Rgb(3, 2, 1));
    EXPECT_EQ(world.lights[1].light.intensity, Rgb(0));
    EXPECT_EQ(world.lights[2].light.intensity, Rgb(3, 2, 1));
}

TEST(WorldEdits, ALampsNameAndIntensityAreChecked) {
    World world;
    const auto said = [&](const std::string& lamp, const Rgb& intensity) {
        try {
            set_intensity(world, lamp, intensity);
        } catch (const Error& error) {
            return error.place() + ": " + error.message();
        }
        return std::string("nothing");
    };
    EXPECT_EQ(said("x", Rgb(1)), "lamp: there is no lamp \"x\"; the scene has none");
    for (const std::string name : {"spot", "bulb", "spot"}) world.lights.emplace_back().light.name = name;
    EXPECT_EQ(said("x", Rgb(1)), "lamp: there is no lamp \"x\"; there are: spot, bulb");
    for (const float bad : {-1.0F, 1e6F, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_THAT(said("spot", Rgb(bad)), testing::StartsWith("intensity: must lie in"));
    EXPECT_EQ(world.lights[0].light.intensity, Rgb(0)) << "nothing changed";
}

TEST(WorldEdits, APieceTurnsAboutItsOwnMiddle) {
    World world;
    world.bodies.emplace_back().name = "furniture";
    world.materials.resize(1);
    Body box;
    box.name = "crate";
    box.positions = {{1, 0, 2}, {2, 0, 2}, {2, 1, 3}, {1, 1, 3}};
    box.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
    add_piece(world, box);
    const auto piece = static_cast<Index>(world.pieces.size() - 1);
    move_piece(world, piece, motion_of(world, piece, {Vec3(0.5F, 0, 0), about_y(90)}));
    const Box bounds = bounds_of(world, piece);
    EXPECT_LE(glm::length(bounds.low - Vec3(1.5F, 0, 2)), 1e-5F);
    EXPECT_LE(glm::length(bounds.high - Vec3(2.5F, 1, 3)), 1e-5F);
}

TEST(WorldEdits, AShiftedPathIsShiftedAtAllTimes) {
    Path path;
    path.keys = {{0, {Vec3(0), about_y(0)}}, {1, {Vec3(1, 2, 3), about_y(40)}}};
    const Path moved = shifted(path, {Vec3(0, 1, 0), about_y(20)});
    for (const double time : {0.0, 0.3, 1.0}) {
        EXPECT_LE(glm::length(moved.at(time).translation - path.at(time).translation - Vec3(0, 1, 0)), 1e-6F);
        const Quat expected = about_y(20) * path.at(time).rotation;
        EXPECT_GE(std::abs(glm::dot(moved.at(time).rotation, expected)), 1 - 1e-5F);
    }
}

}  // namespace
}  // namespace afterglow
