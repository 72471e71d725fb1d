#include "client/text.h"

#include <limits>

#include <gtest/gtest.h>

namespace afterglow::client {
namespace {

using std::chrono::duration;

TEST(Text, OneLineTakesOutEveryControlCharacterAndKeepsUtf8) {
    EXPECT_EQ(one_line("a\nb\r\tc\x1b[31m\x7f"), "a b  c [31m ");
    EXPECT_EQ(one_line("größe ≥ 1 ¢"), "größe ≥ 1 ¢");
    EXPECT_EQ(one_line("x\xC2\x9B"
                       "31m"),
              "x 31m")
        << "the 8-bit form of ESC [";
    EXPECT_EQ(one_line("cut \xC2"), "cut \xC2");
}

TEST(Text, PercentEncodesAllButUnreservedBytes) {
    EXPECT_EQ(percent_encode("a-Z_0.9~"), "a-Z_0.9~");
    EXPECT_EQ(percent_encode("a b/c?d&e=%+"), "a%20b%2Fc%3Fd%26e%3D%25%2B");
    EXPECT_EQ(percent_encode("ü"), "%C3%BC");
}

TEST(Text, SpeaksDurations) {
    EXPECT_EQ(spoken(duration<double>(0)), "0 s");
    EXPECT_EQ(spoken(duration<double>(7.2)), "8 s");
    EXPECT_EQ(spoken(duration<double>(59.5)), "1 min 00 s");
    EXPECT_EQ(spoken(duration<double>(125)), "2 min 05 s");
    EXPECT_EQ(spoken(duration<double>(12000)), "3 h 20 min");
    EXPECT_EQ(spoken(duration<double>(-5)), "0 s");
    EXPECT_EQ(spoken(duration<double>(1e300)), spoken(duration<double>(3.2e9)));
}

TEST(Text, SpeaksBytes) {
    EXPECT_EQ(spoken_bytes(0), "0 bytes");
    EXPECT_EQ(spoken_bytes(7), "7 bytes");
    EXPECT_EQ(spoken_bytes(999), "999 bytes");
    EXPECT_EQ(spoken_bytes(1000), "1.0 kB");
    EXPECT_EQ(spoken_bytes(8568), "8.6 kB");
    EXPECT_EQ(spoken_bytes(9999), "10 kB");
    EXPECT_EQ(spoken_bytes(999'999), "1.0 MB");
    EXPECT_EQ(spoken_bytes(41.2e6), "41 MB");
    EXPECT_EQ(spoken_bytes(1.24e9), "1.2 GB");
}

TEST(Text, WritesPercentagesWithTwoDigits) {
    EXPECT_EQ(percent(0), "0 %");
    EXPECT_EQ(percent(0.0123), "1.2 %");
    EXPECT_EQ(percent(0.37), "37 %");
    EXPECT_EQ(percent(1), "100 %");
    EXPECT_EQ(percent(2.5), "250 %");
    EXPECT_EQ(percent(0.00004), "0.004 %");
}

}  // namespace
}  // namespace afterglow::client
