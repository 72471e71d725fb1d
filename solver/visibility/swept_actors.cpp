#include "solver/visibility/swept_actors.h"

#include <algorithm>
#include <bit>

#include "solver/visibility/moving_faces.h"

namespace afterglow {

ActorTrees make_actor_trees(const World& world) {
    ActorTrees trees(world.bodies.size());
    for (std::size_t b = 1; b < trees.size(); ++b) trees[b] = make_triangle_tree(world.bodies[b]);
    return trees;
}

SweptActors::SweptActors(const World& world, const ActorTrees& trees, const FrameClock& clock,
                         const FrameSpan& frames)
    : world_(&world),
      trees_(&trees),
      frames_(frames),
      poses_(world.bodies.size()),
      steady_after_(world.bodies.size()) {
    Index faces = 0;
    for (const Body& body : world.bodies) {
        first_face_.push_back(faces);
        // The furniture's faces are never met.
        if (first_face_.size() > 1) faces += static_cast<Index>(body.triangles.size());
    }
    for (Index b = 1; b < world.bodies.size(); ++b) {
        const Path& path = world.bodies[b].path;
        for (int f = frames.first; f <= frames.last; ++f) poses_[b].push_back(path.at(clock.time_of(f)));
        steady_after_[b].assign(static_cast<std::size_t>(frames.count()), 0);
        for (SteadyFrames part : steady_frames(path, clock, frames)) {
            part.frames.first -= frames.first;
            part.frames.last -= frames.first;
            sweeps_.push_back({b, part, {}});
            if (part.motion == Motion::turning)
                sweeps_.back().balls = balls_of(part, b);
            else
                std::fill_n(steady_after_[b].begin() + part.frames.first, part.frames.count() - 1, 1);
        }
    }
}

std::vector<SweptActors::Ball> SweptActors::balls_of(const SteadyFrames& part, Index body) const {
    if ((*trees_)[body].nodes.empty()) return {};
    const TriangleTree::Node& root = (*trees_)[body].nodes.front();
    const auto leaves = std::bit_ceil(static_cast<std::size_t>(part.frames.count()));
    std::vector<Ball> balls(2 * leaves);
    for (std::size_t k = 0; k < leaves; ++k) {
        const int frame = std::min(part.frames.first + static_cast<int>(k), part.frames.last);
        balls[leaves + k] = {pose(body, frame).point(root.centre), glm::length(root.half)};
    }
    for (std::size_t k = leaves - 1; k > 0; --k) {
        const Ball &a = balls[2 * k], &b = balls[2 * k + 1];
        const Vec3 centre = 0.5F * (a.centre + b.centre);
        balls[k] = {centre, std::max(glm::length(a.centre - centre) + a.radius_m,
                                     glm::length(b.centre - centre) + b.radius_m)};
    }
    return balls;
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

void SweptActors::trace_turning(const Sweep& sweep, std::size_t ball, const RayPacket& rays,
                                TimeBuffer& buffer) const {
    if (!meets_ball(rays, sweep.balls[ball].centre, sweep.balls[ball].radius_m)) return;
    const std::size_t leaves = sweep.balls.size() / 2;
    if (ball < leaves) {
        trace_turning(sweep, 2 * ball, rays, buffer);
        trace_turning(sweep, 2 * ball + 1, rays, buffer);
        return;
    }
    const int frame = sweep.part.frames.first + static_cast<int>(ball - leaves);
    if (frame > sweep.part.frames.last) return;
    trace_moving_faces({world_->bodies[sweep.body],
                        (*trees_)[sweep.body],
                        first_face_[sweep.body],
                        pose(sweep.body, frame),
                        Vec3(0),
                        {frame, frame}},
                       rays, buffer);
}

SweptActors::Face SweptActors::face(Index number) const {
    const auto next = std::upper_bound(first_face_.begin() + 1, first_face_.end(), number);
    const auto body = static_cast<Index>(next - first_face_.begin() - 1);
    return {body, number - first_face_[body]};
}

void SweptActors::trace(const RayPacket& rays, TimeBuffer& buffer) const {
    for (const Sweep& sweep : sweeps_) {
        if (sweep.part.motion == Motion::turning) {
            if (!sweep.balls.empty()) trace_turning(sweep, 1, rays, buffer);
            continue;
        }
        trace_moving_faces({world_->bodies[sweep.body], (*trees_)[sweep.body], first_face_[sweep.body],
                            sweep.part.first, sweep.part.step_m, sweep.part.frames},
                           rays, buffer);
    }
}

}  // namespace afterglow
