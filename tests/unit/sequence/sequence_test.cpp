#include "solver/sequence/sequence.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <unistd.h>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/base/stopwatch.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

using testing::final_of;
using testing::quick;
using testing::revisions_of;
using testing::same_bits;
using testing::small_room;

/// Everything shines and reflects alike: B = E / (1 − ρ) everywhere, whatever the actors do (closed form 7).
World furnace(float reflectance) {
    World world = small_room();
    world.materials[0] = testing::diffuse("furnace", Rgb(reflectance), Rgb(1));
    // The back of the ceiling lamp is reached too.
    world.materials[0].shines = Material::Shines::both;
    world.materials[1] = world.materials[0];
    return world;
}

TEST(Sequence, AFurnaceIsUniformWhateverTheActorsDo) {
    for (const float reflectance : {0.2F, 0.5F, 0.8F}) {
        SequenceConfig config = quick();
        config.asked_error = 1e-5;
        config.revisions = Revisions::final_only;
        for (const Revision& revision : revisions_of(furnace(reflectance), config, 0, 2))
            for (const Rgb& pixel : revision.radiance.pixels)
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(pixel[c] * (1 - reflectance), 1, 1e-4) << "frame " << revision.frame;
    }
}

TEST(Sequence, AnErrorThatCannotBeCertifiedIsAWarning) {
    SequenceConfig config = quick();
    config.asked_error = 1e-9;
    SequenceState state = make_state(small_room(), config, Context(2));
    const FrameStatistics frame = step(state, 0, {}, Context(2));
    step(state, 1, {}, Context(2));
    EXPECT_GT(frame.error_bound, config.asked_error);
    EXPECT_LT(frame.error_bound, 1e-3);
    ASSERT_EQ(state.warnings().size(), 1U);
    EXPECT_EQ(state.warnings().front().place, "error");
}

TEST(Sequence, TheFirstFrameRefinesBeforeItIsFinal) {
    const auto revisions = revisions_of(small_room(), quick(), 0, 1);
    std::vector<int> count(2);
    for (const Revision& r : revisions) EXPECT_EQ(r.revision, ++count[static_cast<std::size_t>(r.frame)]);
    EXPECT_GE(count[0], 4);
    EXPECT_GE(count[1], 1);
    for (std::size_t k = 0; k < revisions.size(); ++k)
        EXPECT_EQ(revisions[k].final,
                  k + 1 == revisions.size() || revisions[k + 1].frame != revisions[k].frame);
}

TEST(Sequence, PreliminaryPicturesDoNotChangeTheFinalOne) {
    SequenceConfig config = quick();
    const Picture watched = final_of(small_room(), config, 3);
    config.revisions = Revisions::final_only;
    EXPECT_TRUE(same_bits(final_of(small_room(), config, 3), watched));
}

TEST(Sequence, SameBitsForAnyNumberOfThreads) {
    const Picture one = final_of(small_room(), quick(), 5, Context(1));
    EXPECT_TRUE(same_bits(final_of(small_room(), quick(), 5, Context(2)), one));
    EXPECT_TRUE(same_bits(final_of(small_room(), quick(), 5, Context(4)), one));
}

TEST(Sequence, WorkAheadIsToldAndInNoFramesTotal) {
    SequenceConfig config = quick();
    config.visibility = Visibility::events;
    SequenceState state = make_state(small_room(), config, Context(2));
    const Stopwatch watch;
    Milliseconds frames{};
    for (const int frame : {0, 1, 140}) frames += step(state, frame, {}, Context(2)).total;
    const auto& ahead = state.statistics().work_ahead;
    ASSERT_EQ(ahead.size(), 2U);
    EXPECT_TRUE(ahead[0].frames.contains(0) && ahead[0].frames.contains(1));
    EXPECT_TRUE(ahead[1].frames.contains(140));
    EXPECT_GT(total(ahead).count(), 0);
    EXPECT_LE((frames + total(ahead) + state.statistics().static_pass).count(), watch.elapsed().count());
}

TEST(Sequence, EveryVisibilityGivesTheSamePicture) {
    SequenceConfig config = quick();
    config.visibility = Visibility::retrace;
    const Picture retraced = final_of(small_room(), config, 12);
    for (const Visibility visibility :
         {Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        config.visibility = visibility;
        const Picture kept = final_of(small_room(), config, 12);
        double difference = 0, sum = 0;
        for (std::size_t k = 0; k < kept.pixels.size(); ++k) {
            difference += std::abs(kept.pixels[k].x - retraced.pixels[k].x);
            sum += retraced.pixels[k].x;
        }
        EXPECT_LE(difference, 1e-4 * sum) << name_of(visibility);
    }
}

TEST(Sequence, AStopLeavesTheStateUsable) {
    const Context context(2);
    SequenceState state = make_state(small_room(), quick(), context);
    // Stopped after every possible number of pictures of the first frame.
    for (int stop_after = 1; stop_after <= 3; ++stop_after) {
        std::stop_source stop;
        int seen = 0;
        const auto sink = [&](const Revision&) {
            if (++seen == stop_after) stop.request_stop();
        };
        try {
            step(state, 0, sink, Context(2, stop.get_token()));
            FAIL() << "must be stopped";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::cancelled);
        }
    }
    Picture last;
    step(
        state, 0, [&](const Revision& r) { last = r.radiance; }, context);
    EXPECT_TRUE(same_bits(last, final_of(small_room(), quick(), 0)));
}

TEST(Sequence, ASecondJobOnTheSameFurnitureSkipsTheStaticPass) {
    const Context context(2);
    SequenceConfig config = quick();
    config.cache_folder = std::filesystem::path(::testing::TempDir()) /
                          ("afterglow_sequence_cache_" + std::to_string(::getpid()));
    std::filesystem::remove_all(config.cache_folder);
    std::vector<Picture> pictures;
    for (const bool cached : {false, true}) {
        World world = small_room();
        // Another colour and another path: the same furniture.
        if (cached) world.bodies[1].path.keys.back().value.translation.z += 0.1F;
        SequenceState state = make_state(std::move(world), config, context);
        const FrameStatistics frame = step(
            state, 0, [&](const Revision& r) { pictures.push_back(r.radiance); }, context);
        EXPECT_EQ(state.statistics().static_from_cache, cached);
        EXPECT_LE(frame.error_bound, config.asked_error);
    }
    EXPECT_TRUE(same_bits(pictures.front(), pictures[pictures.size() / 2]));
    EXPECT_TRUE(same_bits(pictures[pictures.size() / 2 - 1], pictures.back()));
    std::filesystem::remove_all(config.cache_folder);
}

TEST(Sequence, ProgressRisesToOne) {
    std::vector<double> fractions;
    const Context context(1, {}, [&](const Progress& p) { fractions.push_back(p.fraction); });
    render_sequence(
        small_room(), quick(), 0, 1, [](const Revision&) {}, context);
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_NEAR(fractions.back(), 1, 1e-9);
}

TEST(Sequence, ExposureIsThatOfTimeZeroWhicheverFrameComesFirst) {
    SequenceConfig config = quick();
    config.solution = Solution::progressive;
    const auto whole = revisions_of(small_room(), config, 0, 2);
    const auto part = revisions_of(small_room(), config, 2, 2);
    EXPECT_EQ(whole.back().srgb, part.back().srgb);
}

TEST(Sequence, BadSettingsAreNamed) {
    const auto place_of = [](auto change) {
        SequenceConfig config = quick();
        change(config);
        try {
            make_state(small_room(), config, Context(1));
        } catch (const Error& error) {
            return error.place();
        }
        return std::string("accepted");
    };
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.rays_per_patch = 0; }), "rays");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.patch_size_m = -1; }), "patch_size");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.patch_size_m = 1e-5; }), "patch_size");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.asked_error = 0; }), "error");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.width = 0; }), "size");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.picture_tolerance = -0.1; }), "picture_tolerance");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.camera = "nowhere"; }), "camera");
    EXPECT_EQ(place_of([](SequenceConfig& c) { c.frames_per_second = -24; }), "fps");
    EXPECT_EQ(place_of([](SequenceConfig&) {}), "accepted");
}

TEST(Sequence, LastFrameFollowsDurationAndRate) {
    SequenceConfig config;
    EXPECT_EQ(last_frame_of(small_room(), config), 48);
    config.frames_per_second = 10;
    EXPECT_EQ(last_frame_of(small_room(), config), 20);
}

TEST(Sequence, EstimatesThePicturesErrorOnlyWhereAsked) {
    SequenceConfig config = quick();
    const Picture plain = final_of(small_room(), config, 1);
    config.estimate = Estimate::probes;
    std::vector<Revision> all;
    const auto statistics =
        render_sequence(small_room(), config, 1, 1, [&](const Revision& r) { all.push_back(r); });
    EXPECT_TRUE(same_bits(plain, all.back().radiance)) << "the picture does not depend on it";
    ASSERT_GT(all.size(), 1U);
    EXPECT_FALSE(all.front().picture_error);
    // Patches of 0.4 m and one camera sample where a pixel seems even: some error, but no wrong picture.
    ASSERT_TRUE(all.back().picture_error && statistics.front().picture_error_spread);
    EXPECT_GT(*all.back().picture_error, 0.002);
    EXPECT_LT(*all.back().picture_error, 0.3);
    EXPECT_EQ(all.back().picture_error, statistics.front().picture_error);
    // Half of 64 lines differ from the other half, but not by all the light.
    EXPECT_GT(statistics.front().line_noise.value(), 1e-4);
    EXPECT_LT(statistics.front().line_noise.value(), 0.3);
    EXPECT_EQ(all.back().picture_error_spread, statistics.front().picture_error_spread);

    config.estimate = Estimate::none;
    EXPECT_FALSE(render_sequence(small_room(), config, 1, 1, {}).front().picture_error);
}

TEST(Sequence, TheEstimateOfAFurnaceIsItsRounding) {
    SequenceConfig config = quick();
    config.asked_error = 1e-5;
    config.estimate = Estimate::probes;
    const FrameStatistics frame = render_sequence(furnace(0.5F), config, 0, 0, {}).front();
    EXPECT_LT(*frame.picture_error, 3 * *frame.picture_error_spread + 1e-3);
    EXPECT_LT(*frame.line_noise, 1e-4) << "all lines see the same light";
}

}  // namespace
}  // namespace afterglow
