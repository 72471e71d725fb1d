#include "service/http/chunk_guard.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

bool is_taken(const std::string& body, const ChunkLimits& limits = {}) {
    return ChunkGuard(limits).take(body);
}

TEST(ChunkGuard, TakesWhatIsInOrder) {
    EXPECT_TRUE(is_taken("5\r\nhello\r\nA\r\n0123456789\r\n0\r\n\r\n"));
    EXPECT_TRUE(is_taken("5;name=value\r\nhello\r\n000;last\r\nField: x\r\n\r\n"));
    EXPECT_TRUE(is_taken("5 ;x\r\n;;\r\n;\r\n0\r\n\r\n")) << "data may look like framing";
}

TEST(ChunkGuard, RefusesWhatIsNoChunk) {
    for (const char* body : {"hello", "\r\n", "\n", ";x\r\n", "-1\r\n", "0x5\r\n", "123456789abcdef01\r\n"})
        EXPECT_FALSE(is_taken(body)) << body;
}

TEST(ChunkGuard, LimitsLinesExtensionsAndTrailers) {
    const ChunkLimits limits{20, 30, 10};
    EXPECT_TRUE(is_taken("5;" + std::string(10, 'x') + "\r\n", limits));
    EXPECT_FALSE(is_taken("5;" + std::string(30, 'x'), limits));
    EXPECT_FALSE(is_taken(std::string(30, '0'), limits));
    std::string many;
    for (int i = 0; i < 4; ++i) many += "1;0123456789\r\nx\r\n";
    EXPECT_FALSE(is_taken(many, limits));
    EXPECT_FALSE(is_taken("0\r\n" + std::string(11, 'x'), limits));
}

TEST(ChunkGuard, SplitsDoNotMatter) {
    std::mt19937 random(1);
    std::string body;
    for (int i = 0; i < 50; ++i) {
        const std::string data(random() % 40 + 1, ';');
        constexpr const char* digits = "0123456789abcdef";
        body += std::string{digits[data.size() / 16], digits[data.size() % 16]} + ";e\r\n" + data + "\r\n";
    }
    for (int turn = 0; turn < 50; ++turn) {
        ChunkGuard guard;
        for (std::size_t at = 0; at < body.size();) {
            const std::size_t size = random() % 30 + 1;
            ASSERT_TRUE(guard.take(std::string_view(body).substr(at, size)));
            at += size;
        }
        EXPECT_TRUE(guard.take("0\r\n\r\n"));
        EXPECT_FALSE(ChunkGuard().take("x"));
    }
}

TEST(ChunkGuard, ARefusalIsForGood) {
    ChunkGuard guard;
    EXPECT_FALSE(guard.take("x"));
    EXPECT_FALSE(guard.take("5\r\nhello\r\n"));
}

}  // namespace
}  // namespace afterglow
