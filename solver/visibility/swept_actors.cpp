#include "solver/visibility/swept_actors.h"

#include <algorithm>
#include <bit>

#include "solver/visibility/moving_faces.h"
#include "solver/visibility/packet_hull.h"

namespace afterglow {

ActorTrees make_actor_trees(const World& world) {
    ActorTrees trees(world.bodies.size());
    for (std::size_t b = 1; b < trees.size(); ++b) trees[b] = make_face_tree(world.bodies[b]);
    return trees;
}

SweptActors::SweptActors(const World& world, const ActorTrees& trees, const FrameClock& clock,
                         const FrameSpan& frames)
    : trees_(&trees),
      frames_(frames),
      poses_(world.bodies.size()),
      parts_(world.bodies.size()),
      steady_after_(world.bodies.size()) {
    for (Index b = 0; b < world.bodies.size(); ++b) {
        first_face_.push_back(static_cast<Index>(body_of_face_.size()));
        body_of_face_.insert(body_of_face_.end(), trees[b].faces.size(), b);
    }
    for (Index b = 1; b < world.bodies.size(); ++b) {
        const Path& path = world.bodies[b].path;
        for (int f = frames.first; f <= frames.last; ++f) poses_[b].push_back(path.at(clock.time_of(f)));
        steady_after_[b].assign(static_cast<std::size_t>(frames.count()), 0);
        Swept swept;
        for (SteadyFrames part : steady_frames(path, clock, frames)) {
            part.frames.first -= frames.first;
            part.frames.last -= frames.first;
            if (part.motion != Motion::turning)
                std::fill_n(steady_after_[b].begin() + part.frames.first, part.frames.count() - 1, 1);
            parts_[b].push_back(part);
            if (trees[b].nodes.empty()) continue;
            swept.sweeps.push_back(sweep_of(part, b));
            swept.box.add(swept.sweeps.back().box);
        }
        if (swept.sweeps.empty()) continue;
        reach_m_ = std::max({reach_m_, glm::length(swept.box.low), glm::length(swept.box.high)});
        swept_.push_back(std::move(swept));
    }
}

SweptActors::Sweep SweptActors::sweep_of(const SteadyFrames& part, Index body) const {
    const FaceTree::Node& root = (*trees_)[body].nodes.front();
    Sweep sweep{body, part, {}, {}};
    const float radius_m = glm::length(root.half);
    if (part.motion != Motion::turning) {
        for (const Vec3& at :
             {part.first.point(root.centre),
              part.first.point(root.centre) + static_cast<float>(part.frames.count() - 1) * part.step_m}) {
            const glm::mat3 turned = glm::mat3_cast(part.first.rotation);
            const Vec3 half = glm::abs(turned[0]) * root.half.x + glm::abs(turned[1]) * root.half.y +
                              glm::abs(turned[2]) * root.half.z;
            sweep.box.add(at - half);
            sweep.box.add(at + half);
        }
        return sweep;
    }
    const auto leaves = std::bit_ceil(static_cast<std::size_t>(part.frames.count()));
    std::vector<Ball>& balls = sweep.balls;
    balls.resize(2 * leaves);
    for (std::size_t k = 0; k < leaves; ++k) {
        const int frame = std::min(part.frames.first + static_cast<int>(k), part.frames.last);
        balls[leaves + k] = {pose(body, frame).point(root.centre), radius_m};
        sweep.box.add(balls[leaves + k].centre - radius_m);
        sweep.box.add(balls[leaves + k].centre + radius_m);
    }
    for (std::size_t k = leaves - 1; k > 0; --k) {
        const Ball &a = balls[2 * k], &b = balls[2 * k + 1];
        const Vec3 centre = 0.5F * (a.centre + b.centre);
        balls[k] = {centre, std::max(glm::length(a.centre - centre) + a.radius_m,
                                     glm::length(b.centre - centre) + b.radius_m)};
    }
    return sweep;
}

FaceNumbers SweptActors::numbers(Index body) const {
    const auto count = static_cast<Index>((*trees_)[body].faces.size());
    return {first_face_[body], first_face_[body] + count, first_face_[1]};
}

std::vector<Box> SweptActors::boxes_of(Index body) const {
    // What moves is placed in single precision.
    const Vec3 slack(1e-5F * reach_m_);
    std::vector<Box> boxes;
    for (const Swept& swept : swept_)
        for (const Sweep& sweep : swept.sweeps)
            if (sweep.body == body) boxes.push_back({sweep.box.low - slack, sweep.box.high + slack});
    return boxes;
}

namespace {

/// Whether any ray comes into a ball before its end.
bool meets_ball(const RayPacket& rays, const Vec3& centre, float radius_m) {
    for (std::size_t l = 0; l < rays.count; ++l) {
        const Ray ray = rays.ray(l);
        const Vec3 to = centre - ray.origin;
        const float along = glm::dot(to, ray.direction);
        const Vec3 across = to - along * ray.direction;
        if (glm::dot(across, across) <= radius_m * radius_m && along > -radius_m &&
            along - radius_m < ray.far && ray.far > 0)
            return true;
    }
    return false;
}

}  // namespace

template <class Buffer>
void SweptActors::trace_turning(const Sweep& sweep, std::size_t ball, const RayPacket& rays,
                                Buffer& buffer) const {
    if (!meets_ball(rays, sweep.balls[ball].centre, sweep.balls[ball].radius_m)) return;
    const std::size_t leaves = sweep.balls.size() / 2;
    if (ball < leaves) {
        trace_turning(sweep, 2 * ball, rays, buffer);
        trace_turning(sweep, 2 * ball + 1, rays, buffer);
        return;
    }
    const int frame = sweep.part.frames.first + static_cast<int>(ball - leaves);
    if (frame > sweep.part.frames.last) return;
    trace_moving_faces(
        {(*trees_)[sweep.body], numbers(sweep.body), pose(sweep.body, frame), Vec3(0), {frame, frame}}, rays,
        buffer);
}

template <class Buffer>
void SweptActors::trace_near(const RayPacket& rays, Buffer& buffer) const {
    const PacketHull hull(rays, reach_m_);
    for (const Swept& swept : swept_) {
        if (!hull.may_meet(swept.box)) continue;
        for (const Sweep& sweep : swept.sweeps) {
            if (!hull.may_meet(sweep.box)) continue;
            if (sweep.part.motion == Motion::turning)
                trace_turning(sweep, 1, rays, buffer);
            else
                trace_moving_faces({(*trees_)[sweep.body], numbers(sweep.body), sweep.part.first,
                                    sweep.part.step_m, sweep.part.frames},
                                   rays, buffer);
        }
    }
}

bool SweptActors::any_turns() const {
    const auto turns = [](const SteadyFrames& part) { return part.motion == Motion::turning; };
    return std::any_of(parts_.begin(), parts_.end(), [&](const std::vector<SteadyFrames>& parts) {
        return std::any_of(parts.begin(), parts.end(), turns);
    });
}

namespace {

/// Rays of a body's frame where the body stands.
RayPacket placed(const RayPacket& rays, const Pose& pose) {
    RayPacket out = rays;
    for (std::size_t l = 0; l < rays.count; ++l) {
        Ray ray = rays.ray(l);
        ray.origin = pose.point(ray.origin);
        ray.direction = pose.direction(ray.direction);
        out.set(l, ray);
    }
    out.far = rays.far;
    return out;
}

}  // namespace

void SweptActors::trace_from(Index body, const RayPacket& rays, TimeBuffer& buffer) const {
    for (const SteadyFrames& own : parts_[body]) {
        const RayPacket here = placed(rays, own.first);
        trace_moving_faces({(*trees_)[furniture], FaceNumbers{}, Pose{}, -own.step_m, own.frames}, here,
                           buffer);
        for (Index other = 1; other < parts_.size(); ++other) {
            if (other == body) continue;
            for (const SteadyFrames& part : parts_[other]) {
                const FrameSpan both{std::max(own.frames.first, part.frames.first),
                                     std::min(own.frames.last, part.frames.last)};
                if (both.count() <= 0) continue;
                // The rays stay where they are as the frames of `own` begin.
                Pose first = part.first;
                first.translation += static_cast<float>(both.first - part.frames.first) * part.step_m -
                                     static_cast<float>(both.first - own.frames.first) * own.step_m;
                trace_moving_faces({(*trees_)[other], numbers(other), first, part.step_m - own.step_m, both},
                                   here, buffer);
            }
        }
    }
}

void SweptActors::trace(const RayPacket& rays, TimeBuffer& buffer) const {
    trace_near(rays, buffer);
}

void SweptActors::trace(const RayPacket& rays, HiddenFrames& hidden) const {
    trace_near(rays, hidden);
}

}  // namespace afterglow
