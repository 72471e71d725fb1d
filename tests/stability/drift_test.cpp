// Whatever is carried from frame to frame must not grow.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/stability/animation.h"
#include "tests/stability/follower.h"

namespace afterglow {
namespace {

using test::Animation;
using test::Follower;
using test::Solving;

class Drift : public testing::TestWithParam<Solving> {};

/// Slope of a line fitted to values at 0, 1, 2 … and its standard error.
struct Line {
    double slope = 0;
    double error = 0;
};

Line fit(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0;
    for (const double v : values) mean += v / n;
    double xx = 0;
    double xy = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double x = static_cast<double>(k) - (n - 1) / 2;
        xx += x * x;
        xy += x * (values[k] - mean);
    }
    double left = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double x = static_cast<double>(k) - (n - 1) / 2;
        const double off = values[k] - mean - xy / xx * x;
        left += off * off;
    }
    return {xy / xx, std::sqrt(left / (n - 2) / xx)};
}

/// Moment `frame` of a loop of 20: an occluder comes and goes, a lamp dims, a wall changes colour.
void show(Animation& animation, int frame) {
    const double phase = 2 * std::numbers::pi * frame / 20;
    animation.occlude(12, 3, 0.3 - 0.3 * std::cos(phase));
    animation.problem.emission[0] = Rgb(60, 40, 20) * static_cast<float>(1.2 + std::sin(phase));
    animation.problem.reflectance[5] = Rgb(static_cast<float>(0.4 + 0.4 * std::cos(phase)));
}

TEST_P(Drift, OfAThousandFramesIsNone) {
    Animation animation(4, 30, 0.8F);
    Follower follower(GetParam(), 1e-3);
    constexpr int loop = 20;
    std::vector<double> errors;
    std::vector<Rgb> first;
    for (int frame = 0; frame < 1000; ++frame) {
        show(animation, frame);
        const auto rows = animation.take_rows();
        const Certificate certificate = follower.follow(animation.problem, rows);
        const double error = test::relative_error(animation.problem, follower.irradiance());
        ASSERT_LE(error, certificate.error_bound) << "frame " << frame;
        if (frame == loop) first = follower.irradiance();
        if (frame % loop == 0) errors.push_back(0);
        errors.back() += error / loop;
    }
    // The first loop begins with a cold solution; from the second on nothing may change but by chance.
    errors.erase(errors.begin());
    const Line line = fit(errors);
    EXPECT_LE(std::abs(line.slope), 3 * line.error + 1e-9);

    show(animation, loop);
    const auto rows = animation.take_rows();
    follower.follow(animation.problem, rows);
    const double scale = mean_reflected(animation.problem.view(), first);
    for (std::size_t i = 0; i < first.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double reflectance = animation.problem.reflectance[i][c];
            EXPECT_NEAR(reflectance * follower.irradiance()[i][c], reflectance * first[i][c], 2e-3 * scale);
        }
}

TEST_P(Drift, OfRoundingIsCountedAndForgotten) {
    // Asked for much less than rounding would add up to, were it never forgotten.
    Animation animation(7, 25, 0.7F);
    Follower follower(GetParam(), 2e-4);
    for (int frame = 0; frame < 300; ++frame) {
        show(animation, frame);
        const auto rows = animation.take_rows();
        const Certificate certificate = follower.follow(animation.problem, rows);
        ASSERT_LE(test::relative_error(animation.problem, follower.irradiance()), certificate.error_bound);
    }
}

INSTANTIATE_TEST_SUITE_P(Stability, Drift, testing::ValuesIn(test::all_solving),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace afterglow
