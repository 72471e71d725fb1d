#include "service/base/option_values.h"

#include <functional>
#include <initializer_list>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

/// Expects invalid input at "--x" for each text.
void expect_refused(const std::function<void(std::string_view)>& read,
                    std::initializer_list<std::string_view> texts) {
    for (const auto text : texts) {
        try {
            read(text);
            ADD_FAILURE() << "took \"" << text << "\"";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(e.place(), "--x");
            EXPECT_THAT(e.message(), testing::HasSubstr(std::string(text)));
        }
    }
}

TEST(WholeNumber, TakesTheWholeTextWithinTheRange) {
    EXPECT_EQ(whole_number("--x", "16", 16, 65536), 16);
    EXPECT_EQ(whole_number("--x", "65536", 16, 65536), 65536);
    EXPECT_EQ(whole_number("--x", "-3", -5, 5), -3);
    expect_refused(
        [](std::string_view t) { whole_number("--x", t, 16, 65536); },
        {"", "15", "65537", "-16", "+20", "20.0", "2e2", "0x20", "20 ", " 20", "99999999999999999999"});
}

TEST(DecimalNumber, TakesFiniteNumbersWithinTheRange) {
    EXPECT_EQ(decimal_number("--x", "-1.5", -64, 64), -1.5);
    EXPECT_EQ(decimal_number("--x", "6.4e1", -64, 64), 64);
    expect_refused([](std::string_view t) { decimal_number("--x", t, -64, 64); },
                   {"", "nan", "inf", "-inf", "64.1", "1,5", "1.5x", "1e999"});
}

TEST(PositiveNumber, IsAboveZeroAndFinite) {
    EXPECT_EQ(positive_number("--x", "0.25"), 0.25);
    expect_refused([](std::string_view t) { positive_number("--x", t); }, {"0", "-1", "nan", "inf", "m"});
}

TEST(Share, IsAFractionOrAPercentage) {
    EXPECT_EQ(share("--x", "0.02"), 0.02);
    EXPECT_EQ(share("--x", "2%"), 0.02);
    EXPECT_EQ(share("--x", "0.5%"), 0.005);
    expect_refused([](std::string_view t) { share("--x", t); },
                   {"", "%", "0", "0%", "1", "100%", "2", "-2%", "2%%", "2 %", "nan", "nan%"});
}

TEST(PictureSize, IsTwoNumbersOfPixels) {
    EXPECT_EQ(picture_size("--x", "320x180"), (PictureSize{320, 180}));
    EXPECT_EQ(picture_size("--x", "1x16384"), (PictureSize{1, 16384}));
    expect_refused([](std::string_view t) { picture_size("--x", t); },
                   {"", "320", "320x", "x180", "0x10", "10x0", "16385x1", "-1x-1", "320X180", "320x180x3",
                    "9999999999x1", "16384x16384"});
}

TEST(LinearColour, IsThreeNumbersOfZeroOrMore) {
    EXPECT_EQ(linear_colour("--x", "0.5,0,2e3"), Rgb(0.5F, 0, 2000));
    expect_refused([](std::string_view t) { linear_colour("--x", t); },
                   {"", "1", "1,2", "1,2,3,4", "1,2,-3", "1,2,nan", "1,2,1e39", "1, 2, 3", ",,"});
}

TEST(UnitInMetres, KnowsUnitsAndNumbers) {
    EXPECT_EQ(unit_in_metres("--x", "m"), 1);
    EXPECT_EQ(unit_in_metres("--x", "cm"), 0.01);
    EXPECT_EQ(unit_in_metres("--x", "mm"), 0.001);
    EXPECT_EQ(unit_in_metres("--x", "in"), 0.0254);
    EXPECT_EQ(unit_in_metres("--x", "ft"), 0.3048);
    EXPECT_EQ(unit_in_metres("--x", "0.5"), 0.5);
    expect_refused([](std::string_view t) { unit_in_metres("--x", t); }, {"", "km", "0", "-1", "inf", "1m"});
}

TEST(LengthOfTime, HasAUnit) {
    EXPECT_EQ(length_of_time("x", "90m"), std::chrono::minutes(90));
    EXPECT_EQ(length_of_time("x", "7d"), std::chrono::hours(168));
    for (const char* bad : {"", "7", "d", "0d", "-1h", "1.5h", "7 d", "9999999999999999d", "7w"})
        EXPECT_THROW(length_of_time("x", bad), Error) << bad;
}

TEST(ByteCount, HasAUnit) {
    EXPECT_EQ(byte_count("x", "20GB"), 20'000'000'000U);
    EXPECT_EQ(byte_count("x", "1kB"), 1000U);
    for (const char* bad : {"", "20", "GB", "0GB", "-1GB", "1.5GB", "20gb", "9999999999TB"})
        EXPECT_THROW(byte_count("x", bad), Error) << bad;
}

}  // namespace
}  // namespace afterglow
