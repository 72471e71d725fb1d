// Two rooms that do not see each other: where nothing changes, nothing may flicker.
#include <gtest/gtest.h>

#include "solver/radiosity/incremental.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;

constexpr std::size_t room = 20;

OwnedProblem two_rooms() {
    const OwnedProblem one = test::random_problem(4, room, test::Closure::closed, .8F);
    std::vector<std::vector<double>> rows(2 * room, std::vector<double>(2 * room, 0.0));
    OwnedProblem both;
    for (std::size_t i = 0; i < 2 * room; ++i) {
        const std::size_t k = i % room;
        for (std::uint64_t e = one.matrix.row_begin[k]; e < one.matrix.row_begin[k + 1]; ++e)
            rows[i][one.matrix.column[e] + (i - k)] += static_cast<double>(one.matrix.value[e]);
        both.area.push_back(one.area[k]);
        both.emission.push_back(one.emission[k]);
        both.reflectance.push_back(one.reflectance[k]);
    }
    both.matrix = test::matrix_of(rows);
    return both;
}

TEST(SealedRoom, DoesNotFlickerWithTheOther) {
    OwnedProblem both = two_rooms();
    const FormFactorColumns columns = both.columns();
    ProgressiveConfig config;
    config.asked_error = 0.01;
    config.finish = Finish::bound;
    config.sweep_share = 2;
    IncrementalState state = make_incremental_state(both.view());
    step(state, both.view(), columns, config, Context(1));
    std::vector<Rgb> before;
    const std::uint64_t shots = state.shots;
    for (int frame = 0; frame < 12; ++frame) {
        both.emission[7] += frame % 2 == 0 ? Rgb(20, 10, 5) : Rgb(-20, -10, -5);
        change(state, both.view(), {}, Context(1));
        step(state, both.view(), columns, config, Context(1));
        EXPECT_EQ(state.status, ProgressiveStatus::converged);
        // The first time both states are met, unshot light that was only just little enough may still leave.
        if (frame == 1) before = state.irradiance;
        if (frame < 2) continue;
        for (std::size_t i = room; i < 2 * room; ++i) ASSERT_EQ(state.irradiance[i], before[i]) << frame;
    }
    EXPECT_GT(state.shots, shots);
    // Not until rounding calls for one, some twenty frames on.
    EXPECT_EQ(state.sweeps, 0U);
}

TEST(SealedRoom, StaysExactlyDark) {
    OwnedProblem both = two_rooms();
    for (std::size_t i = room; i < 2 * room; ++i) both.emission[i] = Rgb(0);
    const FormFactorColumns columns = both.columns();
    for (const Finish finish : {Finish::sweep, Finish::bound}) {
        ProgressiveConfig config;
        config.finish = finish;
        IncrementalState state = make_incremental_state(both.view());
        for (int frame = 0; frame < 10; ++frame) {
            both.emission[0] *= frame % 2 == 0 ? 3.0F : 1.0F / 3;
            change(state, both.view(), {}, Context(1));
            step(state, both.view(), columns, config, Context(1));
            for (std::size_t i = room; i < 2 * room; ++i) ASSERT_EQ(state.irradiance[i], Rgb(0));
        }
    }
}

}  // namespace
}  // namespace afterglow
