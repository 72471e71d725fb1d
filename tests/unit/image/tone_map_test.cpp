#include "solver/image/tone_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Picture filled(int width, int height, const Rgb& colour) {
    Picture picture(width, height);
    std::fill(picture.pixels.begin(), picture.pixels.end(), colour);
    return picture;
}

Picture random_picture(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::lognormal_distribution<float> value(0, 2);
    Picture picture(37, 23);
    for (Rgb& pixel : picture.pixels) pixel = Rgb(value(random), value(random), value(random));
    return picture;
}

TEST(SrgbEncoded, MatchesTheStandardAtKnownValues) {
    EXPECT_DOUBLE_EQ(srgb_encoded(0), 0);
    EXPECT_DOUBLE_EQ(srgb_encoded(1), 1);
    EXPECT_DOUBLE_EQ(srgb_encoded(0.002), 0.02584);
    // The inverse of IEC 61966-2-1 at the code 0.5: ((0.5 + 0.055) / 1.055)^2.4.
    EXPECT_NEAR(srgb_encoded(0.21404114048223255), 0.5, 1e-12);
}

TEST(SrgbEncoded, RisesAndJoinsItsTwoPartsWithinTheRoundingOfTheStandard) {
    double before = srgb_encoded(0);
    for (int i = 1; i <= 10000; ++i) {
        const double now = srgb_encoded(i / 10000.0);
        ASSERT_GT(now, before) << i;
        before = now;
    }
    // The standard's printed constants leave a step of 2.3e-8 at the joint.
    EXPECT_NEAR(srgb_encoded(0.0031308), srgb_encoded(std::nextafter(0.0031308, 1.0)), 1e-7);
}

TEST(ToSrgb, GivesTheCodeNearestToTheCurveAlsoBesideWhereCodesBegin) {
    std::vector<float> values{0, 1, -1, 2, std::numeric_limits<float>::denorm_min()};
    for (int code = 1; code < 256; ++code) {
        const double between = (code - 0.5) / 255;
        const auto linear = static_cast<float>(between <= 0.04045 ? between / 12.92
                                                                  : std::pow((between + 0.055) / 1.055, 2.4));
        values.insert(values.end(), {std::nextafter(linear, 0.0F), linear, std::nextafter(linear, 1.0F)});
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<float> value(-0.1F, 1.1F);
    while (values.size() % 3 != 0 || values.size() < 100'000) values.push_back(value(random));
    Picture picture(static_cast<int>(values.size() / 3), 1);
    for (std::size_t k = 0; k < values.size(); ++k)
        picture.pixels[k / 3][static_cast<int>(k % 3)] = values[k];

    for (const float exposure_ev : {0.0F, 0.7F}) {
        const auto rgb = to_srgb(picture, exposure_ev, Context(1));
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double brightened = double{values[k]} * std::exp2(double{exposure_ev});
            ASSERT_EQ(rgb[k], std::lround(255 * srgb_encoded(brightened))) << values[k];
        }
    }
}

TEST(ToSrgb, InvertsEveryCode) {
    Picture ramp(256, 1);
    for (int i = 0; i < 256; ++i) {
        const double v = i / 255.0;
        const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        ramp.at(i, 0) = Rgb(static_cast<float>(linear));
    }
    const auto rgb = to_srgb(ramp, 0, Context(1));
    ASSERT_EQ(rgb.size(), 256U * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(rgb[i], i / 3);
}

TEST(ToSrgb, ClipsAndKeepsChannelsApart) {
    Picture picture(2, 1);
    picture.at(0, 0) = Rgb(-1, 0, 7);
    picture.at(1, 0) = Rgb(1, 0.5F, std::numeric_limits<float>::max());
    EXPECT_THAT(to_srgb(picture, 0, Context(1)), ElementsAre(0, 0, 255, 255, 188, 255));
}

TEST(ToSrgb, AStopIsAFactorOfTwo) {
    const Picture picture = random_picture(1);
    Picture doubled = picture;
    for (Rgb& pixel : doubled.pixels) pixel *= 2.0F;
    EXPECT_EQ(to_srgb(picture, -1, Context(1)), to_srgb(doubled, -2, Context(1)));
}

TEST(ToSrgb, NamesAPixelThatIsNotFinite) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Picture picture = filled(5, 4, Rgb(1));
        picture.at(3, 2).g = bad;
        EXPECT_THAT([&] { to_srgb(picture, 0, Context(1)); },
                    ThrowsMessage<std::logic_error>(HasSubstr("(3, 2)")));
        EXPECT_THAT([&] { automatic_exposure_ev(picture); },
                    ThrowsMessage<std::logic_error>(HasSubstr("(3, 2)")));
    }
}

TEST(AutomaticExposure, MakesAnEvenWallMidBright) {
    for (const float level : {1e-6F, 0.02F, 0.18F, 5.0F, 3e4F}) {
        const Picture wall = filled(8, 8, Rgb(level));
        const auto rgb = to_srgb(wall, automatic_exposure_ev(wall), Context(1));
        // 0.18 encodes to 0.4613 of 255, whatever the wall's level.
        for (const auto value : rgb) EXPECT_EQ(value, 118) << level;
    }
}

TEST(AutomaticExposure, LampsAndBlackGapsHaveNoSay) {
    Picture picture = filled(20, 20, Rgb(0.4F));
    const float alone = automatic_exposure_ev(picture);
    for (int x = 0; x < 20; ++x) {
        picture.at(x, 0) = Rgb(1e5F);  // a lamp over 5 % of the picture
        picture.at(x, 18) = Rgb(0);    // and gaps over 10 %
        picture.at(x, 19) = Rgb(0);
    }
    // The trimmed mean is of equal numbers; only their sum's rounding differs.
    EXPECT_NEAR(automatic_exposure_ev(picture), alone, 1e-5);
}

TEST(AutomaticExposure, FollowsBrightnessStopByStopAndIgnoresTheArrangement) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Picture picture = random_picture(seed);
        const float ev = automatic_exposure_ev(picture);
        Picture brighter = picture;
        for (Rgb& pixel : brighter.pixels) pixel *= 8.0F;
        EXPECT_NEAR(automatic_exposure_ev(brighter), ev - 3, 1e-5) << seed;
        std::reverse(picture.pixels.begin(), picture.pixels.end());
        EXPECT_EQ(automatic_exposure_ev(picture), ev) << seed;
    }
}

TEST(AutomaticExposure, IsNeutralWithoutLightAndBoundedAlways) {
    EXPECT_EQ(automatic_exposure_ev(filled(4, 4, Rgb(0))), 0);
    EXPECT_EQ(automatic_exposure_ev(Picture()), 0);
    EXPECT_EQ(automatic_exposure_ev(filled(4, 4, Rgb(-1))), 0);
    EXPECT_EQ(automatic_exposure_ev(filled(1, 1, Rgb(1e-37F))), 64);
    EXPECT_EQ(automatic_exposure_ev(filled(1, 1, Rgb(1e38F))), -64);
}

}  // namespace
}  // namespace afterglow
