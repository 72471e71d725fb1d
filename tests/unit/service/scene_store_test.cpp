#include "service/store/scene_store.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

using Outcome = SceneStore::Added::Outcome;

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(SceneStore, EqualContentHasOneId) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(fake_scene));
    const auto first = store.add("some bytes", {SceneFormat::glb, "one", {}});
    const auto again = store.add("some bytes", {SceneFormat::glb, "two", {}});
    const auto other = store.add("other bytes", {SceneFormat::glb, "one", {}});
    EXPECT_EQ(first.outcome, Outcome::created);
    EXPECT_EQ(again.outcome, Outcome::known);
    EXPECT_EQ(first.scene.id, again.scene.id);
    EXPECT_NE(first.scene.id, other.scene.id);
    EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(SceneStore, HowBytesAreReadIsPartOfTheId) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(fake_scene));
    SceneUpload upload{SceneFormat::obj, "one", {}};
    const auto metres = store.add("bytes", upload);
    upload.load.obj_unit_m = 0.01;
    const auto centimetres = store.add("bytes", upload);
    upload.load.obj_up = UpAxis::z;
    const auto upright = store.add("bytes", upload);
    EXPECT_NE(metres.scene.id, centimetres.scene.id);
    EXPECT_NE(centimetres.scene.id, upright.scene.id);
}

TEST(SceneStore, TellsWhatWasRead) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(fake_scene));
    const StoredScene scene = store.add("bytes", {SceneFormat::glb, "room.glb", {}}).scene;
    EXPECT_EQ(scene.bytes, 5U);
    EXPECT_EQ(scene.survey.triangles, 1U);
    EXPECT_EQ(scene.survey.actors, 0U);
    EXPECT_EQ(scene.survey.cameras, (std::vector<std::string>{"eye"}));
    EXPECT_EQ(scene.survey.last_frame, 9);
    EXPECT_EQ(to_json(scene).at("name"), "room.glb");
}

TEST(SceneStore, WhatCannotBeReadIsNotKept) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(fake_scene));
    EXPECT_THROW(store.add("bad bytes", {SceneFormat::glb, "x", {}}), Error);
    EXPECT_THROW(store.add_paths("[1]"), Error);
    EXPECT_THROW(store.add_paths("{"), Error);
    EXPECT_EQ(files_in(folder.path()), 0U);
    EXPECT_THROW(static_cast<void>(store.survey("unknown", "", {}, 0)), Error);
}

TEST(SceneStore, TheRealReaderNamesTheUploadInItsErrors) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(usual_reader()));
    try {
        store.add("no scene at all", {SceneFormat::glb, "mine.glb", {}});
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_THAT(e.place(), testing::StartsWith("mine.glb"));
    }
}

TEST(SceneStore, PathsAreKeptByContent) {
    const ScratchFolder folder;
    SceneStore store(folder.path(), surveys_here(fake_scene));
    const std::string id = store.add_paths("{}");
    EXPECT_EQ(store.add_paths("{}"), id);
    EXPECT_NE(store.add_paths("{ }"), id);
    EXPECT_TRUE(store.has_paths(id));
    EXPECT_FALSE(store.has_paths("unknown"));
}

}  // namespace
}  // namespace afterglow
