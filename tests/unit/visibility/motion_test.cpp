#include "solver/visibility/motion.h"

#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "tests/support/worlds.h"

namespace afterglow {
namespace {

Pose at(float x) {
    return {Vec3(x, 0, 0), Quat(1, 0, 0, 0)};
}

TEST(MotionSegments, OfNoKeysRestForEver) {
    const auto segments = motion_segments({});
    ASSERT_EQ(segments.size(), 1U);
    EXPECT_EQ(segments[0].motion, Motion::rest);
    EXPECT_EQ(segments[0].begin_s, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(segments[0].end_s, std::numeric_limits<double>::infinity());
}

TEST(MotionSegments, TellRestTranslationAndTurning) {
    Path path;
    const Quat turned = glm::angleAxis(1.0F, Vec3(0, 0, 1));
    path.keys = {{1, at(0)}, {2, at(1)}, {3, {Vec3(1, 0, 0), turned}}, {4, {Vec3(1, 0, 0), turned}}};
    std::vector<Motion> motions;
    for (const MotionSegment& segment : motion_segments(path)) motions.push_back(segment.motion);
    EXPECT_THAT(motions,
                ::testing::ElementsAre(Motion::rest, Motion::translation, Motion::turning, Motion::rest));
}

TEST(MotionSegments, JumpWithoutASegment) {
    Path path;
    path.keys = {{0, at(0)}, {1, at(0)}, {1, at(5)}, {2, at(6)}};
    const auto segments = motion_segments(path);
    ASSERT_EQ(segments.size(), 3U);
    EXPECT_EQ(segments[0].end_s, 1);
    EXPECT_EQ(segments[0].end, at(0));
    EXPECT_EQ(segments[1].begin, at(5));
    EXPECT_EQ(segments[2].begin, at(6));
}

void expect_poses(const Path& path, const FrameClock& clock, const FrameSpan& range, float tolerance_m) {
    int next = range.first;
    for (const SteadyFrames& part : steady_frames(path, clock, range)) {
        ASSERT_EQ(part.frames.first, next);
        ASSERT_GE(part.frames.count(), 1);
        next = part.frames.last + 1;
        for (int f = part.frames.first; f <= part.frames.last; ++f) {
            const Pose pose = path.at(clock.time_of(f));
            const Vec3 predicted =
                part.first.translation + static_cast<float>(f - part.frames.first) * part.step_m;
            EXPECT_LE(glm::length(predicted - pose.translation), tolerance_m) << "frame " << f;
            if (part.motion != Motion::turning) {
                EXPECT_EQ(pose.rotation, part.first.rotation) << "frame " << f;
            }
        }
    }
    EXPECT_EQ(next, range.last + 1);
}

TEST(SteadyFrames, HoldEveryFrameOnceAndPredictItsPlace) {
    std::mt19937 random(1);
    Box box;
    box.add(Vec3(-5));
    box.add(Vec3(5));
    for (int k = 0; k < 50; ++k) {
        Path path = testing::random_path(random, box, 1 + k % 7,
                                         k % 2 == 0 ? testing::Turning::yes : testing::Turning::no);
        if (k % 3 == 0) path.keys.push_back({path.keys.back().time_s, at(3)});
        for (const double rate : {1.0, 24.0, 29.97, 1000.0}) {
            const FrameClock clock{rate};
            const int last = static_cast<int>(path.keys.back().time_s * rate) + 2;
            expect_poses(path, clock, {0, last}, 2e-5F);
            expect_poses(path, clock, {last / 3, last / 2}, 2e-5F);
        }
    }
}

TEST(SteadyFrames, AKnotExactlyOnAFrameBelongsToWhatFollows) {
    Path path;
    path.keys = {{0, at(0)}, {0.5, at(1)}, {1, at(1)}};
    const auto parts = steady_frames(path, {24}, {0, 24});
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].frames, (FrameSpan{0, 11}));
    EXPECT_EQ(parts[1].frames, (FrameSpan{12, 24}));
}

TEST(SteadyFrames, ThatRangeOverHugeTimesAreFound) {
    Path path;
    path.keys = {{0, at(0)}, {1e12, at(1)}};
    const auto parts = steady_frames(path, {24}, {99'990, 100'000});
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].motion, Motion::translation);
}

TEST(SteadyFrames, MissWhatHappensBetweenTwoFrames) {
    Path path;
    path.keys = {{0.51, at(0)}, {0.52, at(9)}, {0.53, at(0)}};
    const auto parts = steady_frames(path, {2}, {0, 4});
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].motion, Motion::rest);
    EXPECT_EQ(parts[1].motion, Motion::rest);
}

}  // namespace
}  // namespace afterglow
