#include "solver/image/probe_choice.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace afterglow {
namespace {

/// Even but for a line down the middle.
Picture lined(int width, int height) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) picture.at(x, y) = Rgb(x == width / 2 ? 2.0F : 1.0F);
    return picture;
}

TEST(ProbeChoice, TakesAllOfASmallPictureOnce) {
    const auto probes = choose_probes(lined(5, 4), 20, 1);
    ASSERT_EQ(probes.size(), 20U);
    for (std::size_t k = 0; k < probes.size(); ++k) {
        EXPECT_EQ(static_cast<std::size_t>(5 * probes[k].y + probes[k].x), k);
        EXPECT_EQ(probes[k].weight, 1);
    }
}

TEST(ProbeChoice, HalfGoWhereThePictureIsUneven) {
    const auto probes = choose_probes(lined(256, 256), 128, 3);
    ASSERT_EQ(probes.size(), 128U);
    int beside_line = 0;
    double weight_beside_line = 0, weight = 0;
    for (const Probe& probe : probes) {
        EXPECT_LE(probe.weight, 2 + 1e-9);
        weight += probe.weight;
        if (std::abs(probe.x - 128) > 1) continue;
        ++beside_line;
        weight_beside_line += probe.weight;
    }
    EXPECT_NEAR(beside_line, 64, 5);
    // Three columns of 256, and a mean is not drawn to them.
    EXPECT_NEAR(weight_beside_line / weight, 3.0 / 256, 0.004);
    EXPECT_NEAR(weight / 128, 1, 0.05);
}

TEST(ProbeChoice, IsEvenInAnEvenPicture) {
    for (const Probe& probe : choose_probes(Picture(64, 64), 100, 1)) EXPECT_NEAR(probe.weight, 1, 1e-9);
}

TEST(ProbeChoice, GivesEachProbeItsOwnSeed) {
    const auto probes = choose_probes(lined(64, 64), 100, 1);
    for (std::size_t k = 1; k < probes.size(); ++k) EXPECT_NE(probes[k].seed, probes[k - 1].seed);
    EXPECT_NE(choose_probes(lined(64, 64), 100, 2).front().seed, probes.front().seed);
}

}  // namespace
}  // namespace afterglow
