#include "service/base/zip_archive.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/service/zip_builder.h"

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::Pair;

ErrorKind refusal(const std::string& bytes, const ZipLimits& limits = {}) {
    try {
        read_zip(bytes, limits, "archive");
    } catch (const Error& e) {
        EXPECT_TRUE(e.place().starts_with("archive")) << e.place();
        return e.kind();
    }
    ADD_FAILURE() << "was read";
    return ErrorKind::io;
}

/// The archive with a number of one of its local and central headers' fields replaced; both offsets count
/// from the signature.
std::string with_size(std::string bytes, std::uint32_t size) {
    for (const auto& [mark, offset] : {std::pair("PK\3\4", 22), std::pair("PK\1\2", 24)}) {
        const auto at = bytes.find(std::string(mark, 4)) + static_cast<std::size_t>(offset);
        for (unsigned i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(size >> (8 * i));
    }
    return bytes;
}

TEST(ZipArchive, GivesItsFilesInOrderWithoutFolders) {
    const std::string bytes =
        zip_of({{"b.txt", "two"}, {"a/", ""}, {"a/c.txt", std::string(100'000, 'x')}, {"e", ""}});
    EXPECT_THAT(read_zip(bytes, {}, "archive"),
                ElementsAre(Pair("b.txt", "two"), Pair("a/c.txt", std::string(100'000, 'x')), Pair("e", "")));
    EXPECT_LT(bytes.size(), 1000U);
}

TEST(ZipArchive, LimitsHoldBeforeAnythingIsUnpacked) {
    const std::string bytes = zip_of({{"a", std::string(600, 'x')}, {"b", std::string(600, 'x')}});
    EXPECT_EQ(refusal(bytes, {1, 10'000}), ErrorKind::too_large);
    EXPECT_EQ(refusal(bytes, {2, 1199}), ErrorKind::too_large);
    EXPECT_EQ(read_zip(bytes, {2, 1200}, "archive").size(), 2U);
}

TEST(ZipArchive, AFileIsAsLongAsAnnouncedOrDamaged) {
    const std::string bytes = zip_of({{"a", std::string(1'000'000, 'x')}});
    EXPECT_EQ(refusal(with_size(bytes, 10)), ErrorKind::invalid_input);
    EXPECT_EQ(refusal(with_size(bytes, 2'000'000)), ErrorKind::invalid_input);
    EXPECT_EQ(refusal(with_size(bytes, 0xFFFFFFFE), {10, 1'000'000}), ErrorKind::too_large);
}

TEST(ZipArchive, WhatIsDamagedIsRefusedOrReadWithinLimits) {
    const std::string bytes = zip_of({{"a.txt", "some text, some text, some text"}, {"b", "1"}});
    for (std::size_t length = 1; length < bytes.size(); ++length)
        EXPECT_EQ(refusal(bytes.substr(0, length)), ErrorKind::invalid_input) << length;
    EXPECT_EQ(refusal("PK"), ErrorKind::invalid_input);
    std::mt19937 random(1);
    for (int trial = 0; trial < 3000; ++trial) {
        std::string other = bytes;
        for (auto changes = 1 + random() % 3; changes > 0; --changes)
            other[random() % other.size()] = static_cast<char>(random());
        try {
            EXPECT_LE(read_zip(other, {4, 1000}, "archive").size(), 4U);
        } catch (const Error&) {
            continue;
        }
    }
}

TEST(ZipArchive, EncryptedFilesAreNotRead) {
    EXPECT_EQ(refusal(zip_of({{"a", "secret"}}, "password")), ErrorKind::unsupported);
}

}  // namespace
}  // namespace afterglow
