#include "solver/image/pixel_sum.h"

#include <gtest/gtest.h>

namespace afterglow {
namespace {

/// A pixel of two samples on a surface that reflects, with some light straight from a lamp.
PixelTotals pixel_of(float direct, Index surface = 3, float reflectance = 0.5F) {
    PixelSum sum;
    for (int k = 0; k < 2; ++k) {
        SampleLight sample;
        sample.reflectance = Rgb(reflectance);
        // Only one of them sees the lamp.
        sample.direct = Rgb(k == 0 ? direct : 0.0F);
        sample.surface = surface;
        sum.add(sample, {});
    }
    return sum.totals();
}

class ATile : public ::testing::Test {
  protected:
    void show(std::size_t pixel, const PixelTotals& totals) { tile_[pixel] = &totals; }
    void show_everywhere(const PixelTotals& totals) { tile_.fill(&totals); }
    [[nodiscard]] bool may_miss(std::size_t pixel) const { return may_miss_light(tile_, pixel); }

    TileTotals tile_{};
    PixelTotals dark_ = pixel_of(0), lit_ = pixel_of(1);
};

TEST_F(ATile, AllDarkOrAllLitMissesNothing) {
    for (const PixelTotals* totals : {&dark_, &lit_}) {
        show_everywhere(*totals);
        for (std::size_t pixel = 0; pixel < 16; ++pixel) EXPECT_FALSE(may_miss(pixel)) << pixel;
    }
}

TEST_F(ATile, DarkPixelsBesideLitOnesMayMissLight) {
    for (std::size_t lit = 0; lit < 16; ++lit) {
        show_everywhere(dark_);
        show(lit, lit_);
        for (std::size_t pixel = 0; pixel < 16; ++pixel) {
            const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
            const bool beside =
                pixel != lit && apart(pixel % 4, lit % 4) <= 1 && apart(pixel / 4, lit / 4) <= 1;
            EXPECT_EQ(may_miss(pixel), beside) << lit << " " << pixel;
        }
    }
}

TEST_F(ATile, WhereThePictureEndsNothingStands) {
    show(5, dark_);
    EXPECT_FALSE(may_miss(5));
    show(6, lit_);
    EXPECT_TRUE(may_miss(5));
}

TEST_F(ATile, AnotherSurfacesLightSaysNothing) {
    const PixelTotals elsewhere = pixel_of(1, 4);
    show_everywhere(elsewhere);
    show(5, dark_);
    EXPECT_FALSE(may_miss(5));
}

TEST_F(ATile, WhatReflectsNothingMissesNothing) {
    const PixelTotals black = pixel_of(0, 3, 0);
    show_everywhere(lit_);
    show(5, black);
    EXPECT_FALSE(may_miss(5));
}

}  // namespace
}  // namespace afterglow
