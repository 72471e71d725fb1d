#include "solver/base/sampling.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>

namespace afterglow {
namespace {

TEST(Sobol, EveryScramblingIsStratifiedInItsFirstTwoDimensions) {
    constexpr std::size_t count = 256;
    const SobolPoints points(count);
    for (const std::uint64_t seed : {1U, 2U, 77U}) {
        // Each of the elementary intervals of 256 points holds exactly one: 256×1, 128×2, … 1×256 cells.
        for (std::size_t across = 1; across <= count; across *= 2) {
            const std::size_t down = count / across;
            std::set<std::pair<int, int>> cells;
            for (std::size_t k = 0; k < count; ++k) {
                const Sample4 s = points.at(k, seed);
                cells.emplace(static_cast<int>(s[0] * static_cast<float>(across)),
                              static_cast<int>(s[1] * static_cast<float>(down)));
            }
            EXPECT_EQ(cells.size(), count) << across;
        }
        for (std::size_t d = 2; d < 4; ++d) {
            std::set<int> strata;
            for (std::size_t k = 0; k < count; ++k)
                strata.insert(static_cast<int>(points.at(k, seed)[d] * count));
            EXPECT_EQ(strata.size(), count);
        }
    }
}

TEST(Sobol, SeedsGiveDifferentPoints) {
    const SobolPoints points(4);
    EXPECT_NE(points.at(1, 1), points.at(1, 2));
    EXPECT_EQ(points.at(1, 1), points.at(1, 1));
}

TEST(Sobol, SixteenAtOnceAreThoseOneByOne) {
    const SobolPoints points(64);
    std::array<std::uint32_t, 16> index{}, seed{};
    for (std::size_t d = 0; d < 4; ++d) {
        for (std::uint32_t lane = 0; lane < 16; ++lane) {
            index[lane] = (lane * 7) % 64;
            seed[lane] = SobolPoints::seed_of(lane / 3, d);
        }
        std::array<float, 16> out{};
        points.at(d, index, seed, out);
        for (std::uint32_t lane = 0; lane < 16; ++lane)
            EXPECT_EQ(out[lane], points.at(index[lane], lane / 3)[d]) << lane;
    }
}

TEST(CosineDirection, IsUnitAboveTheHorizonWithMeanCosineTwoThirds) {
    const SobolPoints points(4096);
    double mean = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Sample4 s = points.at(k, 9);
        const Vec3 d = cosine_direction(s[0], s[1]);
        EXPECT_NEAR(glm::length(d), 1, 1e-5);
        EXPECT_GE(d.z, 0);
        mean += d.z / 4096.0;
    }
    EXPECT_NEAR(mean, 2.0 / 3, 1e-3);
}

TEST(RandomStream, IsUniformAndItsNeighboursAreIndependent) {
    constexpr int count = 100000;
    double sum = 0, squares = 0, products = 0, across = 0;
    RandomStream stream(mixed(5)), other(mixed(6));
    double before = 0.5;
    for (int k = 0; k < count; ++k) {
        const double x = stream.next();
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        sum += x - 0.5;
        squares += (x - 0.5) * (x - 0.5);
        products += (x - 0.5) * (before - 0.5);
        across += (x - 0.5) * (other.next() - 0.5);
        before = x;
    }
    // Three standard errors: the variance of a uniform number is 1/12, of its square 1/180, of a product
    // 1/144.
    const double three = 3 / std::sqrt(count);
    EXPECT_NEAR(sum / count, 0, three / std::sqrt(12.0));
    EXPECT_NEAR(squares / count, 1 / 12.0, three / std::sqrt(180.0));
    EXPECT_NEAR(products / count, 0, three / 12);
    EXPECT_NEAR(across / count, 0, three / 12);
    EXPECT_EQ(RandomStream(3).next(), RandomStream(3).next());
}

}  // namespace
}  // namespace afterglow
