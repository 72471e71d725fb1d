#include "service/store/blob_store.h"

#include <fstream>

#include <gtest/gtest.h>

#include "service/base/identity.h"
#include "solver/base/error.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

std::string put(BlobStore& store, const std::string& content) {
    EXPECT_TRUE(store.put(sha256(content), content));
    return sha256(content);
}

TEST(BlobStore, KeepsWhatItIsGivenOnce) {
    const ScratchFolder folder;
    BlobStore store(folder.path() / "blobs", 1000);
    EXPECT_FALSE(store.has(sha256("one")));
    const std::string name = put(store, "one");
    EXPECT_FALSE(store.put(name, "one"));
    EXPECT_EQ(store.get(name), "one");
    EXPECT_EQ(store.get(sha256("two")), std::nullopt);
}

TEST(BlobStore, OnlyHashesAreNames) {
    EXPECT_TRUE(BlobStore::is_name(sha256("")));
    EXPECT_FALSE(BlobStore::is_name(""));
    EXPECT_FALSE(BlobStore::is_name("../" + sha256("").substr(3)));
    EXPECT_FALSE(BlobStore::is_name(std::string(64, 'A')));
}

TEST(BlobStore, OutlastsTheProcessAndForgetsWhatIsNotItsOwn) {
    const ScratchFolder folder;
    std::string name;
    {
        BlobStore store(folder.path(), 1000);
        name = put(store, "kept");
    }
    std::ofstream(folder.path() / "half.tmp") << "half";
    BlobStore store(folder.path(), 1000);
    EXPECT_EQ(store.get(name), "kept");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "half.tmp"));
}

TEST(BlobStore, ThoseNotAskedForTheLongestGoFirst) {
    const ScratchFolder folder;
    BlobStore store(folder.path(), 30);
    const std::string first = put(store, "1234567890");
    const std::string second = put(store, "234567890a");
    const std::string third = put(store, "34567890ab");
    EXPECT_TRUE(store.has(first));
    const std::string fourth = put(store, "4567890abc");
    EXPECT_TRUE(store.has(first));
    EXPECT_FALSE(store.has(second));
    EXPECT_TRUE(store.has(third));
    EXPECT_TRUE(store.has(fourth));
    const std::string large(31, 'x');
    EXPECT_THROW(store.put(sha256(large), large), Error);
    EXPECT_TRUE(store.has(first));
}

TEST(BlobStore, DamagedOnesAreDropped) {
    const ScratchFolder folder;
    BlobStore store(folder.path(), 1000);
    const std::string name = put(store, "whole");
    std::ofstream(folder.path() / name, std::ios::trunc) << "who";
    EXPECT_EQ(store.get(name), std::nullopt);
    EXPECT_FALSE(store.has(name));
    EXPECT_TRUE(store.put(name, "whole"));
    EXPECT_EQ(store.get(name), "whole");
}

}  // namespace
}  // namespace afterglow
