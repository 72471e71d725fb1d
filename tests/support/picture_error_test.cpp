#include "tests/support/picture_error.h"

#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace afterglow::test {
namespace {

Picture uniform(int width, int height, float value) {
    Picture picture(width, height);
    for (Rgb& pixel : picture.pixels) pixel = Rgb(value);
    return picture;
}

Picture noisy(const Picture& picture, float sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0, sigma);
    Picture out = picture;
    for (Rgb& pixel : out.pixels) pixel += Rgb(noise(random), noise(random), noise(random));
    return out;
}

TEST(PictureError, IsZeroForTheReferenceItself) {
    const Picture truth = uniform(8, 8, 0.5F);
    EXPECT_EQ(picture_error(truth, truth, truth).relative_rmse, 0);
    EXPECT_EQ(picture_error(truth, truth, truth).used_share, 1);
}

TEST(PictureError, IsTheRelativeDifferenceForAUniformFault) {
    const Picture truth = uniform(8, 8, 0.5F);
    EXPECT_NEAR(picture_error(uniform(8, 8, 0.6F), truth, truth).relative_rmse, 0.2, 1e-6);
    EXPECT_NEAR(picture_error(uniform(8, 8, 0.4F), truth, truth).relative_rmse, 0.2, 1e-6);
}

TEST(PictureError, IsNotInflatedByTheNoiseOfTheReference) {
    // 10 % fault, 20 % noise in each half. Standard error of the estimate of the square, 256² × 3 samples:
    // about sqrt(2·(.1·.2)² + .2⁴)/443 = 1.1e-4, that is 5.5e-4 of the root; five times that is allowed.
    const Picture truth = uniform(256, 256, 1);
    const Picture half_a = noisy(truth, 0.2F, 1);
    const Picture half_b = noisy(truth, 0.2F, 2);
    EXPECT_NEAR(picture_error(uniform(256, 256, 1.1F), half_a, half_b).relative_rmse, 0.1, 0.003);
    // One half against itself shows the inflation that is avoided.
    EXPECT_GT(picture_error(uniform(256, 256, 1.1F), half_a, half_a).relative_rmse, 0.2);
}

TEST(PictureError, CountsTheNoiseOfThePictureItself) {
    const Picture truth = uniform(256, 256, 1);
    EXPECT_NEAR(picture_error(noisy(truth, 0.05F, 3), truth, truth).relative_rmse, 0.05, 0.001);
}

TEST(PictureError, LeavesOutLampsAndTheirNeighbours) {
    Picture truth = uniform(9, 9, 0.5F);
    truth.at(4, 4) = Rgb(0.5F, 0.5F, 3);
    Picture picture = truth;
    for (int y = 3; y <= 5; ++y)
        for (int x = 3; x <= 5; ++x) picture.at(x, y) = Rgb(100);
    EXPECT_EQ(picture_error(picture, truth, truth).relative_rmse, 0);
    EXPECT_NEAR(picture_error(picture, truth, truth).used_share, 72.0 / 81, 1e-12);
    picture.at(2, 4) = Rgb(0.6F);
    EXPECT_GT(picture_error(picture, truth, truth).relative_rmse, 0);
}

TEST(PictureError, ALampInACornerOrInOneHalfOnlyCounts) {
    Picture half_a = uniform(4, 4, 0.5F);
    const Picture half_b = half_a;
    half_a.at(0, 0) = Rgb(2.6F);
    EXPECT_NEAR(picture_error(half_b, half_a, half_b).used_share, 12.0 / 16, 1e-12);
    EXPECT_NEAR(picture_error(half_b, half_b, half_a).used_share, 12.0 / 16, 1e-12);
}

TEST(PictureError, RefusesWhatCannotBeCompared) {
    const Picture truth = uniform(4, 4, 0.5F);
    EXPECT_THROW(picture_error(uniform(4, 5, 1), truth, truth), std::invalid_argument);
    EXPECT_THROW(picture_error(Picture(), Picture(), Picture()), std::invalid_argument);
    EXPECT_THROW(picture_error(truth, uniform(4, 4, 9), truth), std::invalid_argument);
    EXPECT_THROW(picture_error(truth, uniform(4, 4, 0), truth), std::invalid_argument);
    Picture broken = truth;
    broken.at(1, 1).g = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(picture_error(broken, truth, truth), std::invalid_argument);
}

TEST(PictureError, TheHalvesOfEveryReferenceDifferByNoiseOnly) {
    for (const std::string name : {"cornell-slide_0000", "cornell-slide_0012", "cornell-slide_0036",
                                   "living-room_0000", "living-room_0024", "living-room_0072"}) {
        const std::string stem = std::string(AFTERGLOW_TEST_DATA) + "/reference/" + name;
        const Picture a = read_picture(stem + "_1.exr");
        const Picture b = read_picture(stem + "_2.exr");
        ASSERT_EQ(a.width, 256);
        ASSERT_EQ(a.height, 256);
        const auto distance = picture_error(a, b, b);
        EXPECT_GT(distance.relative_rmse, 0) << name << ": the halves are one picture";
        EXPECT_LT(distance.relative_rmse, 0.15) << name << ": more than noise lies between the halves";
        EXPECT_GT(distance.used_share, 0.5) << name;
    }
}

}  // namespace
}  // namespace afterglow::test
