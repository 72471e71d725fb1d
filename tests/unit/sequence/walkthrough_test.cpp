// A camera that walks through a scene in which nothing else moves.
#include <map>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "tests/support/rooms.h"
#include "tests/unit/sequence/quick_sequences.h"

namespace afterglow {
namespace {

using testing::quick;
using testing::rooms_in_a_row;

SequenceConfig walking(Solution solution) {
    SequenceConfig config = quick();
    config.visibility = Visibility::back_buffer;
    config.solution = solution;
    config.revisions = Revisions::final_only;
    return config;
}

struct Walk {
    std::vector<FrameStatistics> frames;
    std::vector<Picture> pictures;
    std::uint64_t shots() const {
        std::uint64_t sum = 0;
        for (const FrameStatistics& frame : frames) sum += frame.shots;
        return sum;
    }
};

Walk walk(const SequenceConfig& config, const std::vector<int>& frames, int rooms = 2) {
    Walk out;
    const Context context(2);
    SequenceState state = make_state(rooms_in_a_row({.rooms = rooms}), config, context);
    for (const int frame : frames)
        out.frames.push_back(step(
            state, frame, [&](const Revision& r) { out.pictures.push_back(r.radiance); }, context));
    return out;
}

TEST(Walkthrough, WhatDoesNotDependOnTheViewIsDoneOnce) {
    std::map<int, std::uint64_t> picture_rays;
    for (const Solution solution : {Solution::residual, Solution::incremental, Solution::in_view}) {
        SequenceConfig config = walking(solution);
        // The view of all these frames is looked at in the first.
        config.frames_looked_ahead = 200;
        const std::vector<int> frames{0, 30, 60, 61, 120, 5};
        const Walk here = walk(config, frames);
        EXPECT_GT(here.frames[0].shots, 0U);
        for (std::size_t k = 1; k < frames.size(); ++k) {
            const FrameStatistics& frame = here.frames[k];
            EXPECT_EQ(frame.shots, 0U) << name_of(solution) << ", frame " << frames[k];
            EXPECT_EQ(frame.visibility_changes, 0U) << name_of(solution) << ", frame " << frames[k];
            // What is left are the picture's own rays, the same whatever the solution.
            const auto [rays, is_new] = picture_rays.try_emplace(frames[k], frame.rays_traced);
            EXPECT_EQ(frame.rays_traced, rays->second) << name_of(solution) << ", frame " << frames[k];
        }
    }
}

/// Largest difference of two pictures relative to the mean of the second.
double difference(const Picture& a, const Picture& b) {
    double largest = 0, sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) {
        largest = std::max(largest, static_cast<double>(max_channel(glm::abs(a.pixels[k] - b.pixels[k]))));
        sum += static_cast<double>(max_channel(b.pixels[k]));
    }
    return largest * static_cast<double>(b.pixels.size()) / sum;
}

TEST(Walkthrough, LightWaitsForTheCameraAndPicturesDoNotShowIt) {
    std::vector<int> frames;
    for (int f = 0; f < 144; f += 12) frames.push_back(f);
    SequenceConfig config = walking(Solution::incremental);
    config.asked_error = 0.001;
    const Walk whole = walk(config, frames);
    config.solution = Solution::in_view;
    config.asked_error = 0.01;
    config.frames_looked_ahead = 12;
    const Walk seen = walk(config, frames);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        EXPECT_LE(seen.frames[k].error_bound, 0.01) << "frame " << frames[k];
        EXPECT_LE(difference(seen.pictures[k], whole.pictures[k]), 0.011) << "frame " << frames[k];
        EXPECT_GT(seen.frames[k].active_patches, 0U);
        EXPECT_LT(seen.frames[k].active_patches, whole.frames[k].active_patches);
    }
    // Everything the camera never sees included.
    config.solution = Solution::incremental;
    config.asked_error = 0.01;
    const Walk all_at_once = walk(config, {0});
    EXPECT_LT(static_cast<double>(seen.frames[0].shots), 0.8 * static_cast<double>(all_at_once.shots()));
    // What waited is sent out on the way.
    EXPECT_GT(seen.shots(), seen.frames[0].shots);
    RecordProperty("shots_whole", std::to_string(all_at_once.shots()));
    RecordProperty("shots_first", std::to_string(seen.frames[0].shots));
    RecordProperty("shots_all", std::to_string(seen.shots()));
}

TEST(Walkthrough, HowFarAheadIsLookedDoesNotShow) {
    const std::vector<int> frames{0, 48, 72, 96, 143};
    SequenceConfig config = walking(Solution::in_view);
    std::vector<Walk> walks;
    for (const int ahead : {1, 24, 144}) {
        config.frames_looked_ahead = ahead;
        walks.push_back(walk(config, frames));
    }
    for (std::size_t k = 0; k < frames.size(); ++k)
        for (const Walk& one : walks)
            EXPECT_LE(difference(one.pictures[k], walks[0].pictures[k]), 2 * 0.02 * 1.1) << frames[k];
    EXPECT_LT(walks[0].frames[0].shots, walks[2].frames[0].shots);
}

TEST(Walkthrough, LooksOneFrameAheadAtLeast) {
    SequenceConfig config = walking(Solution::in_view);
    config.frames_looked_ahead = 0;
    EXPECT_THROW(make_state(rooms_in_a_row({}), config, Context(2)), Error);
}

}  // namespace
}  // namespace afterglow
