#include "solver/sequence/frame_refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gmock/gmock.h>

#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

using testing::final_of;
using testing::quick;
using testing::revisions_of;
using testing::same_bits;
using testing::small_room;

/// Largest difference of two pictures relative to the mean of one.
double largest_difference(const Picture& a, const Picture& b) {
    double largest = 0, sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) {
        largest = std::max(largest, static_cast<double>(max_channel(glm::abs(a.pixels[k] - b.pixels[k]))));
        sum += static_cast<double>(max_channel(b.pixels[k]));
    }
    return largest * static_cast<double>(b.pixels.size()) / sum;
}

TEST(FollowingFrames, HistoryDoesNotMatter) {
    const Context context(2);
    for (const Visibility visibility :
         {Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        SequenceConfig config = quick();
        config.visibility = visibility;
        config.solution = Solution::progressive;
        SequenceState state = make_state(small_room(), config, context);
        Picture last;
        for (const int frame : {0, 7, 3, 140, 5})
            step(
                state, frame, [&](const Revision& r) { last = r.radiance; }, context);
        EXPECT_TRUE(same_bits(last, final_of(small_room(), config, 5))) << name_of(visibility);
    }
}

TEST(FollowingFrames, FollowedLightIsTheColdOneWithinItsPromise) {
    const Context context(2);
    for (const Visibility visibility :
         {Visibility::retrace, Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        SequenceConfig config = quick();
        config.visibility = visibility;
        config.solution = Solution::residual;
        config.rays_per_patch = 32;
        config.patch_size_m = 0.4;
        config.asked_error = 0.001;
        SequenceState state = make_state(small_room(), config, context);
        for (const int frame : {0, 1, 2, 7, 3, 140, 5}) {
            Picture followed;
            const FrameStatistics statistics = step(
                state, frame, [&](const Revision& r) { followed = r.radiance; }, context);
            EXPECT_LE(statistics.error_bound, 0.001);
            // Both keep within their promise of the exact one; the promise is of patches, relative to a mean.
            EXPECT_LE(largest_difference(followed, final_of(small_room(), config, frame)), 0.004)
                << name_of(visibility) << " frame " << frame;
        }
    }
}

TEST(FollowingFrames, EverySolutionsLightIsTheColdOneWithinItsPromise) {
    const Context context(2);
    for (const Solution solution : {Solution::progressive, Solution::incremental, Solution::active_passive,
                                    Solution::residual, Solution::in_view}) {
        SequenceConfig config = quick();
        config.visibility = Visibility::back_buffer;
        config.solution = solution;
        config.rays_per_patch = 32;
        config.asked_error = 0.001;
        SequenceState state = make_state(small_room(), config, context);
        config.solution = Solution::progressive;
        for (const int frame : {0, 1, 2, 40, 3}) {
            Picture followed;
            const FrameStatistics statistics = step(
                state, frame, [&](const Revision& r) { followed = r.radiance; }, context);
            EXPECT_LE(statistics.error_bound, 0.001) << name_of(solution) << " frame " << frame;
            EXPECT_GT(statistics.active_patches, 0U);
            EXPECT_LE(largest_difference(followed, final_of(small_room(), config, frame)), 0.004)
                << name_of(solution) << " frame " << frame;
        }
    }
}

TEST(FollowingFrames, WhereAllActorsRestNotAPixelFlickers) {
    SequenceConfig config = quick();
    config.visibility = Visibility::events;
    config.solution = Solution::residual;
    SequenceState state = make_state(small_room(), config, Context(2));
    std::vector<Picture> pictures;
    // The walker of the small room stands still from two seconds on.
    for (const int frame : {40, 90, 91, 92, 93})
        step(
            state, frame,
            [&](const Revision& r) {
                if (r.final) pictures.push_back(r.radiance);
            },
            Context(2));
    for (std::size_t k = 2; k < pictures.size(); ++k) EXPECT_TRUE(same_bits(pictures[k], pictures[1])) << k;
}

TEST(FollowingFrames, FollowingFramesChangeWhatComparingFinds) {
    std::vector<std::vector<std::uint64_t>> changes;
    for (const Solution solution : {Solution::progressive, Solution::residual}) {
        SequenceConfig config = quick();
        config.visibility = Visibility::events;
        config.solution = solution;
        std::vector<std::uint64_t> of_frames;
        for (const FrameStatistics& frame : render_sequence(small_room(), config, 3, 8, {}, Context(2)))
            of_frames.push_back(frame.visibility_changes);
        changes.push_back(of_frames);
    }
    // The first frame changes from nothing, or from the furniture alone.
    EXPECT_TRUE(std::equal(changes[0].begin() + 1, changes[0].end(), changes[1].begin() + 1));
    EXPECT_GT(changes[0][1], 0U);
}

TEST(FollowingFrames, KeptPicturesAreThoseOfFramesMadeAlone) {
    constexpr int frames = 20;
    SequenceConfig config = quick();
    config.revisions = Revisions::final_only;
    config.quality = Quality::preview;
    config.solution = Solution::progressive;
    const Context context(2);
    // The camera of the fresh ones moves, beyond the frames that are shown: nothing is kept.
    World restless = small_room();
    Key<Pose> later = restless.cameras.front().path.keys.front();
    restless.cameras.front().path.keys.push_back({99, later.value});
    later.value.translation.x += 1;
    restless.cameras.front().path.keys.push_back({100, later.value});
    SequenceState fresh = make_state(std::move(restless), config, context);
    std::vector<Picture> expected(frames);
    for (int f = 0; f < frames; ++f)
        step(
            fresh, f, [&](const Revision& r) { expected[static_cast<std::size_t>(f)] = r.radiance; },
            context);

    std::vector<int> order(frames);
    std::iota(order.begin(), order.end(), 0);
    SequenceState state = make_state(small_room(), config, context);
    const auto expect_same = [&](const char* name) {
        for (const int f : order)
            step(
                state, f,
                [&](const Revision& r) {
                    EXPECT_TRUE(same_bits(r.radiance, expected[static_cast<std::size_t>(f)]))
                        << name << ", frame " << f;
                },
                context);
    };
    expect_same("on");
    std::reverse(order.begin(), order.end());
    expect_same("back");
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    expect_same("at random");
}

TEST(FollowingFrames, APicturesToleranceIsKept) {
    SequenceConfig config = quick();
    config.revisions = Revisions::final_only;
    std::vector<std::vector<Picture>> pictures;
    for (const double tolerance : {0.0, 0.01}) {
        config.picture_tolerance = tolerance;
        auto& run = pictures.emplace_back();
        for (const Revision& r : revisions_of(small_room(), config, 0, 12)) run.push_back(r.radiance);
    }
    for (std::size_t f = 0; f < pictures.front().size(); ++f) {
        double squares = 0, light = 0;
        for (std::size_t k = 0; k < pictures[0][f].pixels.size(); ++k) {
            const Rgb d = pictures[1][f].pixels[k] - pictures[0][f].pixels[k];
            squares += static_cast<double>(glm::dot(d, d));
            light += static_cast<double>(glm::dot(pictures[0][f].pixels[k], pictures[0][f].pixels[k]));
        }
        EXPECT_LE(std::sqrt(squares / light), 0.01) << "frame " << f;
    }
}

TEST(FollowingFrames, NoLineIsTracedTwiceWhereOnlyTheCameraMoves) {
    std::map<int, std::uint64_t> picture_rays;
    for (const Visibility visibility :
         {Visibility::back_buffer, Visibility::temporal_graph, Visibility::events}) {
        World world = small_room();
        for (std::size_t b = 1; b < world.bodies.size(); ++b) {
            const Pose here = world.bodies[b].path.at(0.5);
            world.bodies[b].path.keys = {{0, here}, {2, here}};
        }
        const Pose from = world.cameras.front().path.at(0);
        Pose to = from;
        to.translation += Vec3(0.2F, 0.1F, 0);
        world.cameras.front().path.keys = {{0, from}, {1, to}};
        SequenceConfig config = quick();
        config.visibility = visibility;
        SequenceState state = make_state(std::move(world), config, Context(2));
        for (const int frame : {0, 1, 2, 9, 4}) {
            const FrameStatistics statistics = step(state, frame, {}, Context(2));
            // What is left are the picture's own rays, the same whatever the strategy.
            const auto [rays, is_new] = picture_rays.try_emplace(frame, statistics.rays_traced);
            if (frame > 0) {
                EXPECT_EQ(statistics.rays_traced, rays->second) << name_of(visibility) << " " << frame;
                EXPECT_LT(statistics.rays_traced, state.statistics().sight_lines / 8);
                EXPECT_EQ(statistics.visibility_changes, 0U) << name_of(visibility) << " " << frame;
            }
        }
        EXPECT_TRUE(state.statistics().work_ahead.empty());
    }
}

}  // namespace
}  // namespace afterglow
