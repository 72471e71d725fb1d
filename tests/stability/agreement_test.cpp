// All ways to solve against the direct solution and each other, over random animations.
#include <gtest/gtest.h>

#include "tests/stability/animation.h"
#include "tests/stability/follower.h"

namespace afterglow {
namespace {

using test::Animation;
using test::Follower;
using test::Solving;

/// Changes a few things at random; returns the rows concerned.
std::vector<Index> change_something(Animation& animation) {
    auto& problem = animation.problem;
    auto& random = animation.random;
    const auto patches = static_cast<Index>(problem.area.size());
    const auto colour = [&] {
        return Rgb(static_cast<float>(random() % 100), static_cast<float>(random() % 100), 1.0F) * 0.01F;
    };
    const auto kind = random() % 5;
    if (kind == 0) problem.emission[random() % patches] = 100.0F * colour();
    if (kind == 1) problem.emission[random() % patches] = Rgb(0);
    if (kind == 2) problem.reflectance[random() % patches] = 0.9F * colour();
    if (kind == 3)
        for (Index k = 0; k < 1 + patches / 8; ++k) animation.look_elsewhere(animation.any_patch());
    if (kind == 4) animation.occlude(1 + patches / 2, 1, 0.1 * static_cast<double>(random() % 11));
    if (random() % 6 == 0 && !problem.external_irradiance.empty())
        problem.external_irradiance[random() % patches] = 10.0F * colour();
    return animation.take_rows();
}

TEST(Agreement, CertificatesAreNeverViolated) {
    // 1500 animations of 3 frames, 4 methods: 18,000 solutions against the dense one.
    const double asked[] = {0.3, 0.02, 1e-3};
    int exhausted = 0;
    for (std::uint32_t seed = 0; seed < 1500; ++seed) {
        Animation animation(seed, 1 + seed % 12, seed % 2 == 0 ? 0.6F : 0.95F);
        std::vector<Follower> followers;
        for (const Solving solving : test::all_solving) followers.emplace_back(solving, asked[seed % 3]);
        for (int frame = 0; frame < 3; ++frame) {
            std::vector<Index> rows;
            if (frame > 0) rows = change_something(animation);
            for (Follower& follower : followers) {
                const Certificate certificate = follower.follow(animation.problem, rows);
                test::expect_kept(animation.problem, follower.irradiance(), certificate);
                exhausted += follower.state().status == ProgressiveStatus::exhausted;
            }
        }
        ASSERT_FALSE(HasFailure()) << "seed " << seed;
    }
    EXPECT_LT(exhausted, 100);
}

TEST(Agreement, OfAllMethodsIsWithinTheirCertificates) {
    constexpr double asked = 5e-3;
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
        Animation animation(seed, 60, 0.85F);
        std::vector<Follower> followers;
        for (const Solving solving : test::all_solving) followers.emplace_back(solving, asked);
        std::vector<Index> rows;
        for (int frame = 0; frame < 6; ++frame) {
            for (Follower& follower : followers) follower.follow(animation.problem, rows);
            const std::vector<Rgb>& cold = followers[0].irradiance();
            const double scale = mean_reflected(animation.problem.view(), cold);
            for (const Follower& follower : followers)
                for (std::size_t i = 0; i < cold.size(); ++i) {
                    const Rgb apart = animation.problem.reflectance[i] * (follower.irradiance()[i] - cold[i]);
                    // Twice the asked error, and a little for the means, which differ as much.
                    ASSERT_LE(max_channel(glm::abs(apart)), 2.1 * asked * scale)
                        << "seed " << seed << " frame " << frame;
                }
            rows = change_something(animation);
        }
    }
}

TEST(Agreement, IsToTheBitForAnyNumberOfThreads) {
    for (const Solving solving : test::all_solving) {
        const auto run = [&](int threads) {
            Animation animation(5, 600, 0.9F);
            Follower follower(solving, 1e-2, threads);
            std::vector<std::vector<Rgb>> frames;
            std::vector<Index> rows;
            for (int frame = 0; frame < 4; ++frame) {
                follower.follow(animation.problem, rows);
                frames.push_back(follower.irradiance());
                rows = change_something(animation);
            }
            return frames;
        };
        const auto one = run(1);
        EXPECT_EQ(run(2), one);
        EXPECT_EQ(run(4), one);
    }
}

}  // namespace
}  // namespace afterglow
