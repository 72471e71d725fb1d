#include "solver/visibility/relative_motion.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

double share_of(const MotionSegment& segment, double time_s) {
    return segment.motion == Motion::rest ? 0.0
                                          : (time_s - segment.begin_s) / (segment.end_s - segment.begin_s);
}

Vec3d translation_at(const MotionSegment& segment, double time_s) {
    const Vec3d begin(segment.begin.translation);
    return begin + share_of(segment, time_s) * (Vec3d(segment.end.translation) - begin);
}

glm::dquat rotation_at(const MotionSegment& segment, double time_s) {
    const glm::dquat begin = glm::normalize(glm::dquat(segment.begin.rotation));
    if (segment.motion != Motion::turning) return begin;
    const glm::dquat end = glm::normalize(glm::dquat(segment.end.rotation));
    return glm::normalize(glm::slerp(begin, end, share_of(segment, time_s)));
}

Vec3d velocity_of(const MotionSegment& segment) {
    if (segment.motion == Motion::rest) return Vec3d(0);
    return (Vec3d(segment.end.translation) - Vec3d(segment.begin.translation)) /
           (segment.end_s - segment.begin_s);
}

/// Radians a second.
double turning_rate(const MotionSegment& segment) {
    if (segment.motion != Motion::turning) return 0;
    const glm::dquat between = glm::conjugate(glm::normalize(glm::dquat(segment.begin.rotation))) *
                               glm::normalize(glm::dquat(segment.end.rotation));
    const double half_sine = glm::length(Vec3d(between.x, between.y, between.z));
    return 2 * std::atan2(half_sine, std::abs(between.w)) / (segment.end_s - segment.begin_s);
}

}  // namespace

Vec3d SteadyView::place(const Vec3d& offset_m, double time_s) const {
    const Vec3d across = translation_at(viewer, time_s) + offset_m - translation_at(body, time_s);
    return glm::conjugate(rotation_at(body, time_s)) * across;
}

Vec3d SteadyView::velocity() const {
    return glm::conjugate(rotation_at(body, begin_s)) * (velocity_of(viewer) - velocity_of(body));
}

Vec3d SteadyView::in_world(const Vec3d& direction) const {
    return rotation_at(body, begin_s) * direction;
}

double SteadyView::greatest_speed(const Vec3d& offset_m, double from_s) const {
    const double straight = glm::length(velocity_of(viewer) - velocity_of(body));
    const double rate = turning_rate(body);
    if (rate == 0) return straight;
    // The distance to the body's origin is convex in time, so it is largest at one of the ends.
    const double farthest =
        std::max(glm::length(place(offset_m, from_s)), glm::length(place(offset_m, end_s)));
    // Poses are interpolated in single precision; a thousandth more covers that.
    return 1.001 * (straight + rate * farthest);
}

std::vector<SteadyView> steady_views(const Path& body, const Path& viewer) {
    const std::vector<MotionSegment> of_body = motion_segments(body), of_viewer = motion_segments(viewer);
    std::vector<SteadyView> views;
    for (std::size_t b = 0, v = 0; b < of_body.size() && v < of_viewer.size();) {
        const double begin = std::max(of_body[b].begin_s, of_viewer[v].begin_s);
        const double end = std::min(of_body[b].end_s, of_viewer[v].end_s);
        if (begin < end) views.push_back({begin, end, of_body[b], of_viewer[v]});
        // Two knots at one time end both.
        const bool body_ends = of_body[b].end_s == end, viewer_ends = of_viewer[v].end_s == end;
        if (body_ends) ++b;
        if (viewer_ends) ++v;
    }
    return views;
}

const SteadyView& view_at(std::span<const SteadyView> views, double time_s) {
    const auto after = std::upper_bound(views.begin(), views.end(), time_s,
                                        [](double t, const SteadyView& view) { return t < view.begin_s; });
    return after == views.begin() ? views.front() : *(after - 1);
}

}  // namespace afterglow
