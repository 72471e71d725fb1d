#include "service/base/identity.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(Identity, Sha256AgreesWithThePublishedExamples) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Identity, EveryLengthAroundABlockHasItsOwnHash) {
    std::set<std::string> seen;
    for (std::size_t length = 0; length < 200; ++length) seen.insert(content_id(std::string(length, '\0')));
    EXPECT_EQ(seen.size(), 200U);
}

TEST(Identity, RandomIdsAreSafeInUrlsAndDiffer) {
    std::set<std::string> seen;
    for (int i = 0; i < 1000; ++i) {
        const std::string id = random_id();
        EXPECT_EQ(id.size(), 12U);
        EXPECT_TRUE(std::all_of(id.begin(), id.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= '2' && c <= '9');
        })) << id;
        seen.insert(id);
    }
    // Two equal ones among 1000 of 2^60 would be a broken source of randomness.
    EXPECT_EQ(seen.size(), 1000U);
}

}  // namespace
}  // namespace afterglow
