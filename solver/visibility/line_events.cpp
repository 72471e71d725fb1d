#include "solver/visibility/line_events.h"

#include <algorithm>
#include <utility>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;

struct TimedEvent {
    int frame;
    LineEvent event;
};

/// The events of a chunk of blocks, line by line.
using Part = std::vector<TimedEvent>;

/// What the faces in a lane's time buffer are patches of.
class Targets {
  public:
    explicit Targets(const EventScene& scene)
        : scene_(scene), seen_(static_cast<std::size_t>(scene.actors.frames().count())) {}

    /// By frame, from the buffer's first to its last for this lane.
    std::span<const Index> of(const TimeBuffer& buffer, std::size_t lane, const Ray& ray, Index background) {
        const int first = buffer.first(lane), last = buffer.last(lane);
        for (int f = first; f <= last;) {
            const Index face = buffer.face(lane, f);
            int end = f;
            while (end < last && buffer.face(lane, end + 1) == face && steady(face, end)) ++end;
            if (face == no_index) {
                std::fill(at(f), at(end) + 1, background);
            } else {
                *at(f) = target(buffer, lane, f, ray);
                *at(end) = target(buffer, lane, end, ray);
                fill_between(buffer, lane, f, end, ray);
            }
            f = end + 1;
        }
        return {seen_.data() + first, static_cast<std::size_t>(last - first + 1)};
    }

  private:
    std::vector<Index>::iterator at(int frame) { return seen_.begin() + frame; }
    [[nodiscard]] bool steady(Index face, int frame) const {
        return face == no_index || scene_.actors.is_steady_after(scene_.actors.face(face).body, frame);
    }

    /// The point that is seen runs along a line on the face, and patches are convex: between two places on
    /// one patch it leaves it nowhere.
    void fill_between(const TimeBuffer& buffer, std::size_t lane, int first, int last, const Ray& ray) {
        if (last - first < 2) return;
        if (*at(first) == *at(last)) {
            std::fill(at(first) + 1, at(last), *at(first));
            return;
        }
        const int middle = first + (last - first) / 2;
        *at(middle) = target(buffer, lane, middle, ray);
        fill_between(buffer, lane, first, middle, ray);
        fill_between(buffer, lane, middle, last, ray);
    }

    [[nodiscard]] Index target(const TimeBuffer& buffer, std::size_t lane, int frame, const Ray& ray) const {
        const SweptActors::Face face = scene_.actors.face(buffer.face(lane, frame));
        const Body& body = scene_.world.bodies[face.body];
        const Pose& pose = scene_.actors.pose(face.body, frame);
        const Quat back = glm::conjugate(pose.rotation);
        const auto& v = body.triangles[face.triangle].vertices;
        const Vec3 normal = glm::cross(body.positions[v[1]] - body.positions[v[0]],
                                       body.positions[v[2]] - body.positions[v[0]]);
        const Side side = glm::dot(back * ray.direction, normal) < 0 ? Side::front : Side::back;
        const Vec3 place =
            back * (ray.origin + buffer.depth_m(lane, frame) * ray.direction - pose.translation);
        const Index patch = scene_.mesh.patch_at(face.body, face.triangle, side, place);
        return patch == no_index ? sees_inside : patch;
    }

    const EventScene& scene_;
    std::vector<Index> seen_;
};

/// Puts a line's events where it sees `background` before and after `seen`.
void put_events(Index line, Index background, int first, std::span<const Index> seen, int frames,
                Part& part) {
    Index before = background;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (seen[k] == before) continue;
        part.push_back({first + static_cast<int>(k), {line, before, seen[k]}});
        before = seen[k];
    }
    const int after = first + static_cast<int>(seen.size());
    if (before != background && after < frames) part.push_back({after, {line, before, background}});
}

/// All parts' events by frame; within a frame in the order of the parts.
LineEvents by_frame(const std::vector<Part>& parts, int frames, const Context& context) {
    const auto count = static_cast<std::size_t>(frames);
    LineEvents out;
    // [part][frame]: how many, then where the first goes.
    std::vector<std::vector<std::size_t>> places(parts.size());
    context.for_chunks(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            places[p].assign(count, 0);
            for (const TimedEvent& timed : parts[p]) ++places[p][static_cast<std::size_t>(timed.frame)];
        }
    });
    std::size_t next = 0;
    for (std::size_t f = 0; f < count; ++f) {
        out.first_of_frame.push_back(next);
        for (auto& place : places) next += std::exchange(place[f], next);
    }
    out.first_of_frame.push_back(next);
    out.list.resize(next);
    context.for_chunks(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (const TimedEvent& timed : parts[p])
                out.list[places[p][static_cast<std::size_t>(timed.frame)]++] = timed.event;
    });
    return out;
}

void check_size(std::size_t lines) {
    if (lines > no_index)
        throw Error(ErrorKind::too_large, "rays",
                    "events count 4 billion lines at most; use fewer or larger patches");
}

/// Calls `put(part, block, buffer)` for every block of static patches with a buffer of its own thread's.
template <class Put>
LineEvents collect(const EventScene& scene, const Context& context, const Put& put) {
    const int frames = scene.actors.frames().count();
    const std::size_t blocks = scene.sight.static_blocks();
    std::vector<Part> parts((blocks + blocks_per_chunk - 1) / blocks_per_chunk);
    context.for_chunks(blocks, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        TimeBuffer buffer(frames);
        Targets targets(scene);
        for (std::size_t b = begin; b < end; ++b) put(parts[begin / blocks_per_chunk], b, buffer, targets);
    });
    return by_frame(parts, frames, context);
}

}  // namespace

LineEvents find_line_events(const EventScene& scene, const DirectionRange& range, const Context& context) {
    const LineTargets& background = scene.background.background;
    check_size(background.patch.size());
    const int frames = scene.actors.frames().count();
    return collect(scene, context, [&](Part& part, std::size_t b, TimeBuffer& buffer, Targets& targets) {
        const PatchBlock& block = scene.sight.blocks()[b];
        RayPacket rays;
        for (Index d = range.first; d < range.last; ++d) {
            scene.sight.rays(b, d, Pose{}, rays);
            const std::size_t line = scene.sight.line(block, d, 0);
            std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(line), block.count,
                        rays.far.begin());
            buffer.clear(rays);
            scene.actors.trace(rays, buffer);
            for (std::size_t lane = 0; lane < block.count; ++lane) {
                if (buffer.last(lane) < buffer.first(lane)) continue;
                const Index behind = background.patch[line + lane];
                put_events(static_cast<Index>(line + lane), behind, buffer.first(lane),
                           targets.of(buffer, lane, rays.ray(lane), behind), frames, part);
            }
        }
    });
}

LineEvents find_light_events(const EventScene& scene, const Context& context) {
    check_size(scene.background.light_contribution.size());
    const int frames = scene.actors.frames().count();
    return collect(scene, context, [&](Part& part, std::size_t b, TimeBuffer& buffer, Targets&) {
        const PatchBlock& block = scene.sight.blocks()[b];
        RayPacket rays;
        std::array<float, 16> unused;
        std::vector<Index> seen;
        for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
            if (scene.mesh.body[scene.light.lamp_patch(b, k)] != furniture) continue;
            scene.light.rays(b, k, scene.placed, rays, unused);
            const std::size_t line = scene.light.line(block, k, 0);
            for (std::size_t lane = 0; lane < block.count; ++lane)
                if (!(scene.background.light_contribution[line + lane] > 0)) rays.far[lane] = 0;
            buffer.clear(rays);
            scene.actors.trace(rays, buffer);
            for (std::size_t lane = 0; lane < block.count; ++lane) {
                seen.clear();
                for (int f = buffer.first(lane); f <= buffer.last(lane); ++f)
                    seen.push_back(buffer.face(lane, f) == no_index ? lamp_open : lamp_hidden);
                put_events(static_cast<Index>(line + lane), lamp_open, buffer.first(lane), seen, frames,
                           part);
            }
        }
    });
}

}  // namespace afterglow
