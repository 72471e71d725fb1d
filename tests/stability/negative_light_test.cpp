// Light that is taken away must not take more than there is.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/stability/animation.h"
#include "tests/stability/follower.h"

namespace afterglow {
namespace {

using test::Animation;

/// What is seen of one passage of an occluder, looking after every single shot.
struct Passage {
    std::size_t looks = 0;
    std::size_t negative = 0;  ///< irradiances below zero, over all looks and patches
    double lowest = 0;         ///< the lowest of them, relative to the mean irradiance
    double undershoot = 0;     ///< how far B is below both the old and the new solution, relative to the mean
};

double mean_of(const std::vector<Rgb>& irradiance) {
    double sum = 0;
    for (const Rgb& h : irradiance) sum += h.g;
    return sum / static_cast<double>(irradiance.size());
}

void look(Passage& passage, const Animation& animation, const IncrementalState& state,
          const std::vector<Rgb>& old_light, const std::vector<Rgb>& new_light) {
    const double mean = mean_of(new_light);
    ++passage.looks;
    for (std::size_t i = 0; i < state.irradiance.size(); ++i) {
        const double h = state.irradiance[i].g;
        passage.negative += h < 0;
        passage.lowest = std::min(passage.lowest, h / mean);
        const double least = std::min(old_light[i].g, new_light[i].g);
        const double reflectance = animation.problem.reflectance[i].g;
        passage.undershoot = std::max(passage.undershoot, reflectance * (least - h) / mean);
    }
}

/// An occluder enters and leaves in leaps, as bright as `reflectance`.
Passage pass(std::uint32_t seed, float reflectance) {
    Animation animation(seed, 40, 0.8F);
    for (std::size_t i = 36; i < 40; ++i) {
        animation.problem.reflectance[i] = Rgb(reflectance);
        animation.problem.emission[i] = Rgb(0);
    }
    IncrementalState state = make_incremental_state(animation.problem.view());
    ProgressiveConfig config;
    config.asked_error = 1e-4;
    config.order = ShootingOrder::largest_first;
    config.sweep_share = 2;
    config.finish = Finish::bound;
    step(state, animation.problem.view(), animation.problem.columns(), config, Context(1));
    config.max_shots = 1;
    Passage passage;
    for (const double share : {.4, .9, 1.0, .5, 0.0}) {
        const std::vector<Rgb> old_light = state.irradiance;
        animation.occlude(20, 4, share);
        const auto rows = animation.take_rows();
        const auto new_light = test::solve(animation.problem, 1e-5).state.irradiance;
        const FormFactorColumns columns = animation.problem.columns();
        change(state, animation.problem.view(), rows, Context(1));
        while (state.status == ProgressiveStatus::running) {
            look(passage, animation, state, old_light, new_light);
            step(state, animation.problem.view(), columns, config, Context(1));
        }
    }
    return passage;
}

TEST(NegativeLight, NeverLeavesLessThanNothing) {
    // What a patch has shot is what it once shone with, so no sum of it can fall below zero: only rounding
    // can.
    std::size_t looks = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed)
        for (const float reflectance : {0.0F, 0.3F, 0.9F}) {
            const Passage passage = pass(seed, reflectance);
            looks += passage.looks;
            EXPECT_GE(passage.lowest, -1e-6) << "seed " << seed << ": " << passage.negative << " below zero";
        }
    EXPECT_GT(looks, 10'000U);
}

TEST(NegativeLight, UndershootsLittleOnItsWay) {
    // Between the old and the new light a patch may for a while be darker than in either, where some light
    // has gone already and other has yet to come. Never by more than comes at all; measured: at most 8.8 % of
    // the mean irradiance.
    double largest = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed)
        for (const float reflectance : {0.0F, 0.3F, 0.9F})
            largest = std::max(largest, pass(seed, reflectance).undershoot);
    EXPECT_LT(largest, 0.1);
}

}  // namespace
}  // namespace afterglow
