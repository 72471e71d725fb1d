#include "service/store/frame_store.h"

#include <gtest/gtest.h>

#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

TEST(FrameStore, KeepsEveryRevisionUntilTheFinalOne) {
    const ScratchFolder folder;
    FrameStore store(folder.path());
    for (int revision = 1; revision <= 3; ++revision)
        store.put("job", {7, revision, false, 1.0, {}}, {"png" + std::to_string(revision), "exr"});
    EXPECT_EQ(store.read("job", 7, 1, PictureType::png), "png1");
    EXPECT_EQ(store.read("job", 7, 3, PictureType::png), "png3");
    EXPECT_EQ(store.newest("job", 7)->revision, 3);

    store.put("job", {7, 4, true, 0.1, 0.2}, {"last", "exr4"});
    for (int revision = 1; revision <= 3; ++revision)
        for (const auto type : {PictureType::png, PictureType::exr})
            EXPECT_FALSE(store.read("job", 7, revision, type).has_value());
    EXPECT_EQ(store.read("job", 7, 4, PictureType::exr), "exr4");
    EXPECT_EQ(store.newest("job", 7)->error_bound, 0.2);
}

TEST(FrameStore, FramesAndJobsAreApart) {
    const ScratchFolder folder;
    FrameStore store(folder.path());
    store.put("a", {12345, 1, false, 1, {}}, {"a", "x"});
    store.put("a", {2, 1, true, 1, 0.5}, {"b", "y"});
    store.put("b", {2, 1, true, 1, 0.5}, {"c", "z"});
    const auto frames = store.newest("a");
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].frame, 2);
    EXPECT_EQ(frames[1].frame, 12345);
    EXPECT_EQ(store.read("b", 2, 1, PictureType::png), "c");
    EXPECT_FALSE(store.newest("b", 12345).has_value());
    EXPECT_TRUE(store.newest("unknown").empty());
    EXPECT_FALSE(store.read("unknown", 0, 1, PictureType::png).has_value());
}

TEST(FrameStore, AFolderThatCannotBeMadeIsAnError) {
    EXPECT_THROW(FrameStore("/dev/null/pictures"), Error);
}

}  // namespace
}  // namespace afterglow
