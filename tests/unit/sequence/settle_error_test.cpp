#include "solver/sequence/settle_error.h"

#include <cmath>
#include <stop_token>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/sequence/asked_error.h"
#include "solver/sequence/edits.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

using testing::picture_of;
using testing::same_bits;
using testing::small_room;

/// The small room with a lid under its lamp: all light comes past it at one wall.
World slit_room() {
    World world = small_room();
    testing::add_box(world.bodies[furniture], Vec3(0, 2.5F, 0), Vec3(3.8F, 2.55F, 5), 0);
    return world;
}

ProbeEstimate estimated(double error, double standard_error = 0) {
    return {.relative_error = error, .standard_error = standard_error};
}

SequenceConfig asking(double error) {
    SequenceConfig config;
    config.asked_error = error;
    config.width = 24;
    config.height = 16;
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    return config;
}

SequenceState state_asking(double error) {
    return make_state(small_room(), asking(error), Context(2));
}

TEST(ErrorToMakeFor, IsTheSameWhereAPictureIsNearEnough) {
    for (const double error : {0.0, 0.01, 0.02, 0.0219})
        EXPECT_EQ(error_to_make_for(0.02, 0.02, estimated(error)), 0.02) << error;
    EXPECT_EQ(error_to_make_for(0.02, 0.01, estimated(0.015, 0.005)), 0.01);
}

TEST(ErrorToMakeFor, IsSmallerTheFartherOffAPictureIs) {
    double coarser = 0.05;
    for (double error = 0.056; error < 1; error *= 1.1) {
        const double finer = error_to_make_for(0.05, 0.05, estimated(error));
        EXPECT_LT(finer, 0.05) << error;
        EXPECT_LE(finer, coarser) << error;
        EXPECT_GE(finer, 0.05 / 2 * (1 - 1e-12)) << error;
        coarser = finer;
    }
    EXPECT_NEAR(coarser, 0.025, 1e-12);
}

TEST(ErrorToMakeFor, EstimatesThatDifferALittleLeadToTheSame) {
    EXPECT_EQ(error_to_make_for(0.02, 0.02, estimated(0.030)),
              error_to_make_for(0.02, 0.02, estimated(0.031)));
}

TEST(ErrorToMakeFor, WhatIsNotKnownCountsAsError) {
    EXPECT_LT(error_to_make_for(0.05, 0.05, estimated(0, 0.13)), 0.05);
    EXPECT_LT(error_to_make_for(0.02, 0.02, estimated(0.017, 0.008)), 0.02);
    EXPECT_EQ(error_to_make_for(0.02, 0.02, estimated(0, 0.021)), 0.02);
}

TEST(ErrorToMakeFor, IsNotBelowWhatIsPromisedNorMadeAgainForNextToNothing) {
    EXPECT_EQ(error_to_make_for(0.01, 0.009, estimated(0.5)), finest_promised_error);
    EXPECT_EQ(error_to_make_for(0.01, 0.0075, estimated(0.5)), 0.0075);
    EXPECT_EQ(error_to_make_for(0.001, 0.001, estimated(0.5)), 0.001);
}

TEST(ErrorToMakeFor, ErrorsThatGetNoCoarserPicturesBeginWithTheCoarsest) {
    EXPECT_NEAR(error_to_make_for(0.5, 0.5, estimated(0.9)), coarsest_error / 2, 1e-12);
    EXPECT_NEAR(error_to_make_for(0.2, 0.2, estimated(0.225)), coarsest_error / std::sqrt(2), 1e-12);
}

TEST(SettleError, APictureNearEnoughSettlesIt) {
    SequenceState state = state_asking(0.1);
    SequenceState::Parts& parts = state.parts();
    ASSERT_TRUE(is_to_be_settled(parts));
    const Index patches = parts.mesh.size();
    EXPECT_FALSE(settle_error(parts, estimated(0.05), Context(2)));
    EXPECT_FALSE(is_to_be_settled(parts));
    EXPECT_EQ(parts.mesh.size(), patches);
    EXPECT_EQ(state.statistics().made_for_error, 0.1);
    EXPECT_TRUE(state.warnings().empty());
}

TEST(SettleError, APictureTooFarOffIsMadeAgainMoreFinely) {
    SequenceState harder = state_asking(0.1);
    SequenceState::Parts& finer = harder.parts();
    const Index patches = finer.mesh.size();
    EXPECT_TRUE(settle_error(finer, estimated(0.3), Context(2)));
    EXPECT_GT(finer.mesh.size(), patches);
    EXPECT_EQ(finer.config.asked_error, 0.05);
    EXPECT_TRUE(is_to_be_settled(finer));
    // Just what asking for so much would have given.
    SequenceConfig config = asking(0.1);
    config.made_for_error = 0.05;
    SequenceState known = make_state(small_room(), config, Context(2));
    EXPECT_FALSE(is_to_be_settled(known.parts()));
    EXPECT_EQ(finer.mesh.size(), known.parts().mesh.size());
    EXPECT_FALSE(settle_error(finer, estimated(0.05), Context(2)));
    EXPECT_TRUE(same_bits(picture_of(harder, 1), picture_of(known, 1)));
    EXPECT_EQ(harder.statistics().made_for_error, 0.05);
    EXPECT_EQ(known.statistics().made_for_error, 0.05);
}

TEST(SettleError, TriesTwiceAndWarnsOfWhatIsLeft) {
    SequenceState state = state_asking(0.1);
    for (const int tries_left : {1, 0}) {
        EXPECT_TRUE(settle_error(state.parts(), estimated(0.3), Context(2)));
        ASSERT_TRUE(is_to_be_settled(state.parts()));
        EXPECT_EQ(state.parts().settling->tries_left, tries_left);
        EXPECT_TRUE(state.warnings().empty());
    }
    EXPECT_FALSE(settle_error(state.parts(), estimated(0.3), Context(2)));
    EXPECT_FALSE(is_to_be_settled(state.parts()));
    EXPECT_NEAR(*state.statistics().made_for_error, 0.025, 1e-12);
    EXPECT_EQ(state.warnings().size(), 1U);

    SequenceState fine = state_asking(0.5 * finest_promised_error);
    const std::size_t before = fine.warnings().size();
    EXPECT_FALSE(settle_error(fine.parts(), estimated(0.3, 0.1), Context(2)));
    ASSERT_EQ(fine.warnings().size(), before + 1);
    EXPECT_EQ(fine.warnings().back().place, "error");
    EXPECT_THAT(fine.warnings().back().message, ::testing::HasSubstr("30 %"));
}

TEST(SettleError, IsNotAskedWhereTheErrorIsTheCertificateOnly) {
    SequenceConfig config = asking(0.05);
    config.patch_size_m = 0.5;
    SequenceState state = make_state(small_room(), config, Context(2));
    EXPECT_FALSE(is_to_be_settled(state.parts()));
    picture_of(state, 0);
    EXPECT_EQ(state.statistics().made_for_error, std::nullopt);
}

TEST(SettleError, WhicheverFrameComesFirstItIsThatOfTimeZero) {
    SequenceState first = state_asking(0.1), later = state_asking(0.1);
    picture_of(first, 0);
    const Picture shown = picture_of(later, 2);
    ASSERT_TRUE(first.statistics().made_for_error);
    EXPECT_EQ(first.statistics().made_for_error, later.statistics().made_for_error);
    EXPECT_EQ(first.statistics().patches, later.statistics().patches);
    // The frame begins as in a job that knew it all before.
    SequenceConfig config = asking(0.1);
    config.made_for_error = later.statistics().made_for_error;
    SequenceState known = make_state(small_room(), config, Context(2));
    EXPECT_TRUE(same_bits(shown, picture_of(known, 2)));
}

TEST(SettleError, AStopLeavesTheQuestionOpen) {
    SequenceState state = state_asking(0.1);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(settle_error(state.parts(), estimated(0.3), Context(2, stop.get_token())), Error);
    EXPECT_TRUE(is_to_be_settled(state.parts()));
    EXPECT_EQ(state.parts().config.asked_error, 0.1);
    SequenceState fresh = state_asking(0.1);
    EXPECT_TRUE(same_bits(picture_of(state, 0), picture_of(fresh, 0)));
}

TEST(SettleError, AStopLeavesAJobThatCanBeEdited) {
    const World world = small_room();
    const Path still{{{0.0, world.bodies[1].path.keys.front().value}}};
    SequenceState stopped = state_asking(0.1), fresh = state_asking(0.1);
    for (SequenceState* state : {&stopped, &fresh}) picture_of(*state, 0);
    stopped.parts().settling = Settling{.asked = 0.1};
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(settle_error(stopped.parts(), estimated(0.3), Context(2, stop.get_token())), Error);
    stopped.parts().settling.reset();
    for (SequenceState* state : {&stopped, &fresh})
        set_path(*state, world.bodies[1].name, 0.1, still, Context(2));
    EXPECT_TRUE(same_bits(picture_of(stopped, 3), picture_of(fresh, 3)));
}

TEST(SettleError, AStopAtAnyTimeBeforeTheFirstFrameChangesNothing) {
    SequenceState fresh = make_state(slit_room(), asking(0.1), Context(2)),
                  stopped = make_state(slit_room(), asking(0.1), Context(2));
    const Picture whole = picture_of(fresh, 2);
    EXPECT_LT(*fresh.statistics().made_for_error, 0.1);
    int stops = 0;
    for (bool finished = false; !finished; stops += 2) {
        std::stop_source stop;
        int reports = 0;
        const auto sink = [&](const Progress&) {
            if (++reports > stops) stop.request_stop();
        };
        try {
            step(stopped, 2, {}, Context(2, stop.get_token(), sink));
            finished = true;
        } catch (const Error& error) {
            ASSERT_EQ(error.kind(), ErrorKind::cancelled);
        }
    }
    EXPECT_GT(stops, 10);
    EXPECT_EQ(stopped.statistics().made_for_error, fresh.statistics().made_for_error);
    EXPECT_TRUE(same_bits(picture_of(stopped, 2), whole));
}

TEST(SettleError, WhatComesBeforeTheFirstFrameCountsAsItsCostAndProgress) {
    for (const int first : {0, 2}) {
        SequenceConfig config = asking(0.1);
        SequenceState settling = make_state(slit_room(), config, Context(2));
        double last = 0;
        const auto sink = [&](const Progress& progress) {
            EXPECT_GE(progress.fraction, last - 1e-12) << progress.doing << ", frame " << first;
            last = progress.fraction;
        };
        const FrameStatistics cost = step(settling, first, {}, Context(2, {}, sink));
        EXPECT_EQ(last, 1);
        config.made_for_error = settling.statistics().made_for_error;
        ASSERT_LT(*config.made_for_error, 0.1) << "must be made again, or nothing is tested";
        SequenceState known = make_state(slit_room(), config, Context(2));
        EXPECT_GT(cost.rays_traced, step(known, first, {}, Context(2)).rays_traced);
        // What was looked ahead for a picture that was not shown has been paid for, too.
        const std::size_t looked_ahead = known.statistics().work_ahead.size();
        EXPECT_GE(settling.statistics().work_ahead.size(), first == 0 ? looked_ahead + 1 : looked_ahead);
    }
}

}  // namespace
}  // namespace afterglow
