#pragma once

#include <vector>

#include "solver/scene/world.h"

namespace afterglow {

/// What a body does between two knots.
enum class Motion {
    rest,         ///< stays where it is
    translation,  ///< moves at constant velocity and does not turn
    turning,      ///< turns, and may move as well
};

/// The time between two knots of a path, [begin_s, end_s): the motion is steady. The first segment of a path
/// begins at −∞ and the last ends at +∞, where the body rests.
struct MotionSegment {
    Motion motion = Motion::rest;
    double begin_s = 0, end_s = 0;
    Pose begin;  ///< at begin_s
    Pose end;    ///< as time comes to end_s; the next segment may begin elsewhere (a jump)
};

/// The segments of a path in order of time, without gaps; jumps have none of their own, and segments that
/// rest next to each other are one. Thread-safety: pure.
std::vector<MotionSegment> motion_segments(const Path& path);

/// Whether anything of a world is ever elsewhere than at another time. Thread-safety: pure.
bool anything_moves(const World& world);

/// Which times a sequence's frames show.
struct FrameClock {
    double frames_per_second = 24;
    [[nodiscard]] double time_of(int frame) const { return frame / frames_per_second; }
};

/// Consecutive frames, the last one included.
struct FrameSpan {
    int first = 0, last = 0;
    [[nodiscard]] int count() const { return last - first + 1; }
    [[nodiscard]] bool contains(int frame) const { return first <= frame && frame <= last; }
    bool operator==(const FrameSpan&) const = default;
};

/// What a body does over some consecutive frames: it moves by the same step from each to the next.
struct SteadyFrames {
    Motion motion = Motion::rest;
    FrameSpan frames;
    Pose first;      ///< at the first of the frames
    Vec3 step_m{0};  ///< from each frame to the next; also where it turns
};

/// A path as seen by the frames of a range only: whatever happens between two frames and is over by the
/// second leaves no trace. Segments without a frame in the range are left out; together the parts hold every
/// frame of the range once, in order. Thread-safety: pure.
std::vector<SteadyFrames> steady_frames(const Path& path, const FrameClock& clock, const FrameSpan& range);

}  // namespace afterglow
