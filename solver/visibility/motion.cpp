#include "solver/visibility/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

Motion motion_between(const Pose& begin, const Pose& end) {
    if (begin.rotation != end.rotation) return Motion::turning;
    return begin.translation == end.translation ? Motion::rest : Motion::translation;
}

void append(std::vector<MotionSegment>& segments, const MotionSegment& segment) {
    const bool same_rest = !segments.empty() && segments.back().motion == Motion::rest &&
                           segment.motion == Motion::rest && segments.back().end == segment.begin;
    if (same_rest)
        segments.back().end_s = segment.end_s;
    else
        segments.push_back(segment);
}

/// The first frame whose time is not before `time_s`, as the clock itself counts, limited to the range.
int first_frame_from(double time_s, const FrameClock& clock, const FrameSpan& range) {
    const double guess = std::ceil(time_s * clock.frames_per_second);
    // Clamped while it is still a double: infinities and huge times must not become integers.
    int frame = static_cast<int>(
        std::clamp(guess, static_cast<double>(range.first), static_cast<double>(range.last) + 1));
    while (frame > range.first && clock.time_of(frame - 1) >= time_s) --frame;
    while (frame <= range.last && clock.time_of(frame) < time_s) ++frame;
    return frame;
}

}  // namespace

std::vector<MotionSegment> motion_segments(const Path& path) {
    constexpr double never = std::numeric_limits<double>::infinity();
    std::vector<MotionSegment> segments;
    if (path.keys.empty()) return {{Motion::rest, -never, never, {}, {}}};
    const auto& front = path.keys.front();
    append(segments, {Motion::rest, -never, front.time_s, front.value, front.value});
    for (std::size_t k = 0; k + 1 < path.keys.size(); ++k) {
        const auto& from = path.keys[k];
        const auto& to = path.keys[k + 1];
        if (from.time_s == to.time_s) continue;
        append(segments,
               {motion_between(from.value, to.value), from.time_s, to.time_s, from.value, to.value});
    }
    const auto& back = path.keys.back();
    append(segments, {Motion::rest, back.time_s, never, back.value, back.value});
    return segments;
}

bool anything_moves(const World& world) {
    return std::any_of(world.bodies.begin() + 1, world.bodies.end(), [](const Body& body) {
        const auto& keys = body.path.keys;
        return std::any_of(keys.begin(), keys.end(),
                           [&](const Key<Pose>& key) { return !(key.value == keys.front().value); });
    });
}

std::vector<SteadyFrames> steady_frames(const Path& path, const FrameClock& clock, const FrameSpan& range) {
    std::vector<SteadyFrames> parts;
    for (const MotionSegment& segment : motion_segments(path)) {
        const FrameSpan frames{first_frame_from(segment.begin_s, clock, range),
                               first_frame_from(segment.end_s, clock, range) - 1};
        if (frames.count() <= 0) continue;
        SteadyFrames part{segment.motion, frames, path.at(clock.time_of(frames.first)), Vec3(0)};
        if (segment.motion != Motion::rest) {
            const double frames_long = (segment.end_s - segment.begin_s) * clock.frames_per_second;
            part.step_m =
                (segment.end.translation - segment.begin.translation) / static_cast<float>(frames_long);
        }
        parts.push_back(part);
    }
    return parts;
}

}  // namespace afterglow
