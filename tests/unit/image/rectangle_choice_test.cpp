#include "solver/image/rectangle_choice.h"

#include <array>
#include <functional>

#include <gtest/gtest.h>

#include "solver/base/sampling.h"
#include "solver/formfactor/closed_forms.h"
#include "tests/support/random_rectangles.h"

namespace afterglow {
namespace {

using testing::RandomRectangles;

/// Mean over [0,1)².
double mean_over_square(std::size_t count, const std::function<double(float, float)>& f) {
    const SobolPoints points(count);
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Sample4 s = points.at(k, 11);
        sum += f(s[0], s[1]);
    }
    return sum / static_cast<double>(count);
}

TEST(RectangleChoice, BentPlacesLieAsDenselyAsTheySay) {
    RandomStream random(3);
    for (int round = 0; round < 50; ++round) {
        // Some corners weigh nothing; in the first round none does.
        const auto weight = [&] { return round == 0 || random.next() < 0.3F ? 0.0F : 7 * random.next(); };
        const CornerWeights w{weight(), weight(), weight(), weight()};
        const auto integral = [&](const std::function<double(double, double)>& f) {
            return mean_over_square(4096, [&](float s, float t) {
                const BentPlace at = bend(s, t, w);
                EXPECT_TRUE(at.s >= 0 && at.s < 1 && at.t >= 0 && at.t < 1 && at.density > 0.09F);
                return f(double{at.s}, double{at.t}) / double{at.density};
            });
        };
        EXPECT_NEAR(integral([](double, double) { return 1; }), 1, 5e-3);
        EXPECT_NEAR(integral([](double s, double) { return s; }), 0.5, 5e-3);
        EXPECT_NEAR(integral([](double s, double t) { return s * t * t; }), 1.0 / 6, 5e-3);
    }
}

TEST(RectangleChoice, PlacesChosenForAPointGiveItItsFormFactor) {
    RandomRectangles random(5);
    for (int round = 0; round < 100; ++round) {
        const RectangleLight light = random.rectangle();
        const Vec3 from = random.point_before(light), normal = random.normal();
        const double exact = random.form_factor(light, from, normal);
        const double mean = mean_over_square(1 << 14, [&](float s, float t) {
            return testing::irradiance_share(point_for(light, from, normal, s, t), from, normal);
        });
        EXPECT_NEAR(mean, exact, 4e-3 * exact + 2e-5) << round;
    }
}

TEST(RectangleChoice, PlacesForAPointBringMoreEvenLightThanUniformOnes) {
    RandomRectangles random(7);
    double bent_square = 0, uniform_square = 0;
    for (int round = 0; round < 200; ++round) {
        const RectangleLight light = random.rectangle();
        const Vec3 from = random.point_before(light), normal = random.normal();
        const double exact = random.form_factor(light, from, normal);
        if (exact < 1e-4) continue;
        const auto variance = [&](const auto& choose) {
            return mean_over_square(1024, [&](float s, float t) {
                const double share = testing::irradiance_share(choose(s, t), from, normal) / exact - 1;
                return share * share;
            });
        };
        bent_square += variance([&](float s, float t) { return point_for(light, from, normal, s, t); });
        uniform_square += variance([&](float s, float t) { return RectangleView(light, from).at(s, t); });
    }
    EXPECT_LT(bent_square, 0.5 * uniform_square);
}

TEST(RectangleChoice, WhatARectangleIsExpectedToGiveIsNearlyWhatItGivesFromAfar) {
    RandomRectangles random(9);
    for (int round = 0; round < 100; ++round) {
        const RectangleLight light = random.rectangle();
        const RectangleAxes axes(light);
        const Vec3 centre = light.corner + 0.5F * (light.edge_u + light.edge_v);
        const Vec3 from = centre + 3 * glm::length(light.edge_u + light.edge_v) *
                                       glm::normalize(axes.normal + 0.4F * random.normal());
        const Vec3 normal = glm::normalize(centre - from);
        const RectangleSight sight = sight_of(light, axes, from, normal);
        const double exact = double{pi} * random.form_factor(light, from, normal);
        EXPECT_NEAR(sight.expected(axes, corner_gains(sight, axes)), exact, 0.01 * exact);
    }
}

TEST(RectangleChoice, NearByARectangleIsChosenByWhatItGivesToAFactorOfFour) {
    const RectangleLight light{Vec3(-0.5F, 0, 0.5F), Vec3(1, 0, 0), Vec3(0, 0, -1)};  // shines upwards
    const RectangleAxes axes(light);
    ASSERT_GT(axes.normal.y, 0);
    const Vec3 down(0, -1, 0);
    for (const float x : {0.0F, 0.25F, 0.45F, 0.5F})
        for (const float height : {0.001F, 0.02F, 0.05F, 0.1F, 0.2F, 0.5F, 1.0F, 3.0F}) {
            const Vec3 from(x, height, 0.2F);
            const RectangleSight sight = sight_of(light, axes, from, down);
            const float radius_squared = 0.5F, squared = std::max(glm::dot(from, from), radius_squared);
            const float weight = weight_of(sight.expected(axes, corner_gains(sight, axes)), 1 / squared,
                                           squared, radius_squared);
            const auto exact =
                static_cast<float>(double{pi} * RandomRectangles::form_factor(light, from, down));
            EXPECT_GT(weight, exact / 4) << x << " " << height;
            EXPECT_LT(weight, exact * 4) << x << " " << height;
        }
}

}  // namespace
}  // namespace afterglow
