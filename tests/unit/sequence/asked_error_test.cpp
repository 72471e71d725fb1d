#include "solver/sequence/asked_error.h"

#include <gtest/gtest.h>

#include "solver/sequence/sequence.h"
#include "tests/support/worlds.h"

namespace afterglow {
namespace {

constexpr double measured_pixels = 256 * 256;

SequenceConfig asking(double error) {
    SequenceConfig config;
    config.asked_error = error;
    return config;
}

TEST(AskedError, SmallerErrorsNeverTakeLess) {
    QualityLevel coarser = level_for_error(0.9, measured_pixels);
    for (double error = 0.2; error > 0.001; error *= 0.97) {
        const QualityLevel level = level_for_error(error, measured_pixels);
        EXPECT_GE(level.cells, coarser.cells) << error;
        EXPECT_LE(level.finest_share, coarser.finest_share) << error;
        EXPECT_GE(level.rays_per_patch, coarser.rays_per_patch) << error;
        EXPECT_GE(level.picture.samples_per_pixel, coarser.picture.samples_per_pixel) << error;
        EXPECT_GE(level.picture.most_samples_per_pixel, coarser.picture.most_samples_per_pixel) << error;
        EXPECT_GE(level.picture.light_samples_per_point, coarser.picture.light_samples_per_point) << error;
        EXPECT_LE(level.picture.noise, coarser.picture.noise) << error;
        EXPECT_EQ(level.certificate, error);
        coarser = level;
    }
}

TEST(AskedError, SmallerPicturesGetMoreSamplesWhereTheyHaveEdges) {
    for (const double error : {0.05, 0.02, 0.01}) {
        const QualityLevel measured = level_for_error(error, measured_pixels);
        const QualityLevel quarter = level_for_error(error, measured_pixels / 4);
        EXPECT_NEAR(quarter.picture.most_samples_per_pixel, 2 * measured.picture.most_samples_per_pixel, 1);
        EXPECT_EQ(quarter.picture.samples_per_pixel, measured.picture.samples_per_pixel);
        EXPECT_EQ(quarter.cells, measured.cells);
        EXPECT_EQ(level_for_error(error, 1).picture.most_samples_per_pixel,
                  level_for_error(error, measured_pixels / 16).picture.most_samples_per_pixel);
        EXPECT_EQ(level_for_error(error, 4e6).picture.most_samples_per_pixel,
                  measured.picture.most_samples_per_pixel);
    }
}

TEST(AskedError, StaysWithinBounds) {
    const QualityLevel tiny = level_for_error(1e-9, measured_pixels),
                       huge = level_for_error(0.999, measured_pixels);
    EXPECT_LE(tiny.cells, 200'000);
    EXPECT_LE(tiny.rays_per_patch, 4096);
    EXPECT_LE(tiny.picture.most_samples_per_pixel, 1024);
    EXPECT_GE(huge.cells, 1000);
    EXPECT_GE(huge.rays_per_patch, 16);
    EXPECT_GE(huge.picture.samples_per_pixel, 1);
}

TEST(AskedError, TakesTheQualitysPlace) {
    SequenceConfig config = asking(0.1);
    config.quality = Quality::final;
    config.seed = 7;
    const QualityLevel level = level_of(config);
    EXPECT_EQ(level.cells, level_for_error(0.1, measured_pixels).cells);
    EXPECT_EQ(level.certificate, 0.1);
    EXPECT_EQ(level.picture.seed, 7U);
    EXPECT_EQ(level.probes.seed, 7U);
}

TEST(AskedError, WithLinesOrPatchesGivenIsTheCertificateOnly) {
    for (const bool lines : {false, true}) {
        SequenceConfig config = asking(0.001);
        if (lines)
            config.rays_per_patch = 64;
        else
            config.patch_size_m = 0.3;
        const QualityLevel level = level_of(config);
        config.asked_error.reset();
        const QualityLevel by_quality = level_of(config);
        EXPECT_EQ(level.certificate, 0.001);
        EXPECT_EQ(level.rays_per_patch, by_quality.rays_per_patch);
        EXPECT_EQ(level.cells, by_quality.cells);
        EXPECT_EQ(level.picture.most_samples_per_pixel, by_quality.picture.most_samples_per_pixel);
    }
}

TEST(AskedError, WhatCannotBePromisedIsAWarning) {
    const auto warnings = [](SequenceConfig config) {
        config.width = config.height = 8;
        return make_state(testing::small_room(), config, Context(2)).warnings();
    };
    EXPECT_TRUE(warnings(asking(0.05)).empty());
    const Warnings fine = warnings(asking(0.5 * finest_promised_error));
    ASSERT_EQ(fine.size(), 1U);
    EXPECT_EQ(fine.front().place, "error");
    // A certificate can be that fine.
    SequenceConfig given = asking(0.5 * finest_promised_error);
    given.patch_size_m = 0.5;
    EXPECT_TRUE(warnings(given).empty());
}

}  // namespace
}  // namespace afterglow
