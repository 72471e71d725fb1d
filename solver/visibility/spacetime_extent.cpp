#include "solver/visibility/spacetime_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace afterglow {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Box grown(const Box& box, float by) {
    return box.empty() ? box : Box{box.low - Vec3(by), box.high + Vec3(by)};
}

/// The box around a box that stands at a pose.
Box placed(const Box& local, const Pose& pose) {
    Box out;
    for (int corner = 0; corner < 8; ++corner)
        out.add(pose.point(Vec3((corner & 1) != 0 ? local.high.x : local.low.x,
                                (corner & 2) != 0 ? local.high.y : local.low.y,
                                (corner & 4) != 0 ? local.high.z : local.low.z)));
    return out;
}

Pose pose_in(const MotionSegment& segment, double time_s) {
    if (segment.motion == Motion::rest) return segment.begin;
    const auto share = static_cast<float>((time_s - segment.begin_s) / (segment.end_s - segment.begin_s));
    const Vec3 translation = glm::mix(segment.begin.translation, segment.end.translation, share);
    if (segment.motion == Motion::translation) return {translation, segment.begin.rotation};
    return {translation, glm::normalize(glm::slerp(segment.begin.rotation, segment.end.rotation, share))};
}

/// What a body sweeps in the part of a span in which a segment holds.
void add_swept(Box& out, const Box& local, const MotionSegment& segment, const TimeSpan& span) {
    const double begin = std::max(segment.begin_s, span.begin_s), end = std::min(segment.end_s, span.end_s);
    if (begin > end) return;
    if (segment.motion == Motion::rest) {
        out.add(placed(local, segment.begin));
        return;
    }
    const Pose first = pose_in(segment, begin), last = pose_in(segment, end);
    Box box = placed(local, first);
    box.add(placed(local, last));
    if (segment.motion == Motion::turning) {
        const float half_cosine = std::min(1.0F, std::abs(glm::dot(first.rotation, last.rotation)));
        const float radius = glm::length(glm::max(glm::abs(local.low), glm::abs(local.high)));
        box = grown(box, radius * (1 - half_cosine));
    }
    out.add(box);
}

/// Values of a box's points along a direction of a coordinate plane.
struct Stretch {
    float low, high;
};
Stretch stretch_of(const Box& box, int i, int j, float along_i, float along_j) {
    const float middle = along_i * (box.low[i] + box.high[i]) + along_j * (box.low[j] + box.high[j]);
    const float reach =
        std::abs(along_i) * (box.high[i] - box.low[i]) + std::abs(along_j) * (box.high[j] - box.low[j]);
    return {middle - reach, middle + reach};
}

/// Whether the blocker lies beyond both others along a direction.
bool apart(const Box& blocker, const Box& target, const Box& from, int i, int j, float along_i,
           float along_j) {
    const Stretch b = stretch_of(blocker, i, j, along_i, along_j);
    const Stretch t = stretch_of(target, i, j, along_i, along_j);
    const Stretch f = stretch_of(from, i, j, along_i, along_j);
    // Rounding must not part what touches.
    const float slack = 1e-6F * (std::abs(b.low) + std::abs(b.high));
    return b.low > std::max(t.high, f.high) + slack || b.high < std::min(t.low, f.low) - slack;
}

}  // namespace

TimeSpan TimeTree::slice(std::size_t index) const {
    return {index == 0 ? -never : borders_s[index - 1], index == borders_s.size() ? never : borders_s[index]};
}

std::size_t TimeTree::slice_at(double time_s) const {
    const auto after = std::upper_bound(borders_s.begin(), borders_s.end(), time_s);
    return static_cast<std::size_t>(after - borders_s.begin());
}

TimeTree make_time_tree(std::span<const Path> paths, double slice_s, int most_levels) {
    double first = never, last = -never;
    for (const Path& path : paths) {
        if (!path.moves()) continue;
        first = std::min(first, path.keys.front().time_s);
        last = std::max(last, path.keys.back().time_s);
    }
    TimeTree times;
    if (!(first < last)) {
        // Nothing moves, or everything that does jumps at once.
        if (first == last) times.borders_s.push_back(first);
        return times;
    }
    std::size_t slices = 2;
    for (int level = 1; level < most_levels && (last - first) > slice_s * static_cast<double>(slices);
         ++level)
        slices *= 2;
    for (std::size_t k = 1; k < slices; ++k)
        times.borders_s.push_back(first +
                                  (last - first) * static_cast<double>(k) / static_cast<double>(slices));
    return times;
}

Box placed_box(const Box& local, const Pose& pose, float slack_m) {
    return local.empty() ? local : grown(placed(local, pose), slack_m);
}

SpacetimeExtent swept_extent(const Box& local, const Path& path, const TimeTree& times, float slack_m) {
    if (local.empty()) return resting_extent(local);
    if (!path.moves()) return resting_extent(grown(placed(local, path.at(0)), slack_m));
    SpacetimeExtent extent;
    extent.box.resize(2 * times.slices());
    const std::vector<MotionSegment> segments = motion_segments(path);
    for (std::size_t k = 0; k < times.slices(); ++k) {
        Box box;
        for (const MotionSegment& segment : segments) add_swept(box, local, segment, times.slice(k));
        extent.box[times.slices() + k] = grown(box, slack_m);
    }
    for (std::size_t node = times.slices() - 1; node > 0; --node) {
        extent.box[node] = extent.box[2 * node];
        extent.box[node].add(extent.box[2 * node + 1]);
    }
    return extent;
}

SpacetimeExtent resting_extent(const Box& box) {
    return {{box}};
}

bool may_hide(const Box& blocker, const Box& target, const Box& from) {
    if (blocker.empty() || target.empty() || from.empty()) return false;
    for (int axis = 0; axis < 3; ++axis)
        if (apart(blocker, target, from, axis, axis, 0.5F, 0.5F)) return false;
    // The hull's other planes join corresponding edges of the two boxes: in each coordinate plane a line
    // through corresponding corners.
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        for (int corner = 0; corner < 4; ++corner) {
            const auto across = [&](int axis, int bit) {
                return (corner & bit) != 0 ? target.high[axis] - from.high[axis]
                                           : target.low[axis] - from.low[axis];
            };
            if (apart(blocker, target, from, i, j, -across(j, 2), across(i, 1))) return false;
        }
    }
    return true;
}

namespace {

void add_spans(const SpacetimeExtent& blocker, const SpacetimeExtent& target, const SpacetimeExtent& from,
               const TimeTree& times, std::size_t node, std::vector<TimeSpan>& out) {
    if (!may_hide(blocker.at(node), target.at(node), from.at(node))) return;
    if (node < times.slices()) {
        add_spans(blocker, target, from, times, 2 * node, out);
        add_spans(blocker, target, from, times, 2 * node + 1, out);
        return;
    }
    const TimeSpan span = times.slice(node - times.slices());
    if (!out.empty() && out.back().end_s == span.begin_s)
        out.back().end_s = span.end_s;
    else
        out.push_back(span);
}

}  // namespace

std::vector<TimeSpan> hiding_spans(const SpacetimeExtent& blocker, const SpacetimeExtent& target,
                                   const SpacetimeExtent& from, const TimeTree& times) {
    std::vector<TimeSpan> spans;
    if (blocker.box.size() == 1 && target.box.size() == 1 && from.box.size() == 1) {
        if (may_hide(blocker.box[0], target.box[0], from.box[0])) spans.push_back({-never, never});
    } else {
        add_spans(blocker, target, from, times, 1, spans);
    }
    return spans;
}

}  // namespace afterglow
