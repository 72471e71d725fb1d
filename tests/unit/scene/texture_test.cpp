#include "solver/scene/texture.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

/// Single precision: a weight and a product may each round once.
constexpr float rounding = 1e-6F;

/// 2 × 2: black, red / green, white.
Texture four_texels() {
    return {"four", 2, 2, {0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255, 255, 255, 255, 255}};
}

void expect_near(const Rgb& value, const Rgb& expected, float tolerance = rounding) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], tolerance);
}

TEST(Texture, DecodesSrgb) {
    EXPECT_EQ(linear_from_srgb(0), 0.0F);
    EXPECT_EQ(linear_from_srgb(255), 1.0F);
    // Code 10 lies on the straight part, 0.04045 · 255 = 10.3; code 188 is known to be about one half.
    EXPECT_NEAR(linear_from_srgb(10), 10.0 / 255 / 12.92, 1e-7);
    EXPECT_NEAR(linear_from_srgb(188), 0.5028865, 1e-6);
    for (int code = 1; code < 256; ++code)
        EXPECT_GT(linear_from_srgb(static_cast<std::uint8_t>(code)),
                  linear_from_srgb(static_cast<std::uint8_t>(code - 1)));
}

TEST(Texture, TexelCentresGiveTheTexels) {
    const Texture texture = four_texels();
    expect_near(texture.at({0.25F, 0.25F}), Rgb(0));
    expect_near(texture.at({0.75F, 0.25F}), Rgb(1, 0, 0));
    expect_near(texture.at({0.25F, 0.75F}), Rgb(0, 1, 0));
    expect_near(texture.at({0.75F, 0.75F}), Rgb(1));
}

TEST(Texture, BlendsLinearLightBetweenCentres) {
    const Texture texture = four_texels();
    expect_near(texture.at({0.5F, 0.25F}), Rgb(0.5F, 0, 0));
    expect_near(texture.at({0.25F, 0.375F}), Rgb(0, 0.25F, 0));
    expect_near(texture.at({0.5F, 0.5F}), Rgb(0.5F, 0.5F, 0.25F));
}

TEST(Texture, RepeatsAndBlendsAcrossTheSeam) {
    const Texture texture = four_texels();
    expect_near(texture.at({0, 0.25F}), Rgb(0.5F, 0, 0));
    for (const int shift : {-7, -1, 1, 2, 100})
        for (float u = 0.0625F; u < 1; u += 0.125F)
            for (float v = 0.0625F; v < 1; v += 0.125F) {
                const auto s = static_cast<float>(shift);
                // The shift costs the coordinate up to 100 · 2^-24, times two texels.
                expect_near(texture.at({u + s, v - s}), texture.at({u, v}), 3e-5F);
            }
}

TEST(Texture, AnyCoordinateIsSafe) {
    const Texture texture = four_texels();
    for (const float u :
         {std::nanf(""), std::numeric_limits<float>::infinity(), -1e38F, 1e38F, -1e-30F, 1.0F})
        for (const float v : {-std::numeric_limits<float>::infinity(), 3e9F, -0.0F}) {
            const Rgb colour = texture.at({u, v});
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(colour[c], 0.0F);
                EXPECT_LE(colour[c], 1.0F);
            }
        }
}

TEST(Texture, OneTexelAndNone) {
    const Texture one{"one", 1, 1, {255, 0, 255, 0}};
    expect_near(one.at({0.3F, 17.9F}), Rgb(1, 0, 1));
    expect_near(Texture{}.at({0, 0}), Rgb(1));
    expect_near(mean_colour(Texture{}), Rgb(1));
}

TEST(Texture, MeanIsOfLinearLight) {
    expect_near(mean_colour(four_texels()), Rgb(0.5F, 0.5F, 0.25F));
}

}  // namespace
}  // namespace afterglow
