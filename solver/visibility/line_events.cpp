#include "solver/visibility/line_events.h"

#include <algorithm>
#include <utility>

#include "solver/base/error.h"
#include "solver/visibility/block_lines.h"

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 4;
// A line of an actor sweeps past much of the furniture, and looks at all that it may meet.
constexpr std::size_t most_faces_of_furniture = 2048;

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

    /// By frame, from the buffer's first to its last for this lane. The ray belongs to a body and is given in
    /// its frame.
    std::span<const Index> of(const TimeBuffer& buffer, std::size_t lane, const Ray& ray, Index body,
                              Index background) {
        const int first = buffer.first(lane), last = buffer.last(lane);
        const auto faces = buffer.faces(lane);
        const auto depths_m = buffer.depths_m(lane);
        for (int f = first; f <= last;) {
            const Index number = faces[static_cast<std::size_t>(f)];
            int end = f + 1;
            while (end <= last && faces[static_cast<std::size_t>(end)] == number) ++end;
            if (number == no_index)
                std::fill(at(f), at(end), background);
            else
                look_up({scene_, scene_.actors.face(number), depths_m, ray, body}, f, end);
            f = end;
        }
        return {seen_.data() + first, static_cast<std::size_t>(last - first + 1)};
    }

  private:
    /// One ray on one face.
    struct Sight {
        const EventScene& scene;
        SweptActors::Face face;
        std::span<const float> depths_m;  ///< by frame
        Ray ray;
        Index body;  ///< in whose frame it is

        [[nodiscard]] Pose pose(Index of, int frame) const {
            return of == furniture ? Pose{} : scene.actors.pose(of, frame);
        }
        /// Whether both bodies go on as they came.
        [[nodiscard]] bool is_steady_after(int frame) const {
            const auto steady = [&](Index of) {
                return of == furniture || scene.actors.is_steady_after(of, frame);
            };
            return steady(body) && steady(face.body);
        }
        /// The patch that is seen in a frame.
        [[nodiscard]] Index target(int frame) const {
            const Pose from = pose(body, frame), to = pose(face.body, frame);
            const Quat back = glm::conjugate(to.rotation);
            Ray seen{back * (from.point(ray.origin) - to.translation), back * from.direction(ray.direction)};
            Hit hit;
            hit.body = face.body;
            hit.distance = depths_m[static_cast<std::size_t>(frame)];
            hit.side = glm::dot(seen.direction, face.shape.normal) < 0 ? Side::front : Side::back;
            hit.triangle = face.shape.triangle_at(seen.origin + hit.distance * seen.direction);
            return target_of(hit, seen, scene.mesh);
        }
    };

    std::vector<Index>::iterator at(int frame) { return seen_.begin() + frame; }

    /// Frames [first, end) in which one face is seen, part by part of the actors' ways.
    void look_up(const Sight& sight, int first, int end) {
        while (first < end) {
            int last = first;
            while (last + 1 < end && sight.is_steady_after(last)) ++last;
            *at(first) = sight.target(first);
            if (last > first) *at(last) = sight.target(last);
            fill_between(sight, first, last);
            first = last + 1;
        }
    }

    /// The point that is seen runs along a line on the face, and patches are convex: between two places on
    /// one patch it leaves it nowhere.
    void fill_between(const Sight& sight, int first, int last) {
        if (last - first < 2) return;
        if (*at(first) == *at(last)) {
            std::fill(at(first) + 1, at(last), *at(first));
            return;
        }
        const int middle = first + (last - first) / 2;
        *at(middle) = sight.target(middle);
        fill_between(sight, first, middle);
        fill_between(sight, middle, last);
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

/// Calls `find(first block, end, part)` for chunks of the blocks [first, last).
template <class Find>
LineEvents collect(const EventScene& scene, std::size_t first, std::size_t last, const Context& context,
                   const Find& find) {
    std::vector<Part> parts((last - first + blocks_per_chunk - 1) / blocks_per_chunk);
    context.for_chunks(last - first, blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        find(first + begin, first + end, parts[begin / blocks_per_chunk]);
    });
    return by_frame(parts, scene.actors.frames().count(), context);
}

bool is_wanted(const PacketMask& wanted, std::size_t packet) {
    return wanted.empty() || wanted[packet] != 0;
}

void find_in_block(const EventScene& scene, std::size_t b, const DirectionRange& range,
                   const PacketMask& wanted, TimeBuffer& buffer, Targets& targets, Part& part) {
    const LineTargets& background = scene.background.background;
    const int frames = scene.actors.frames().count();
    const PatchBlock& block = scene.sight.blocks()[b];
    const BlockLines of_block(scene.sight, b, Pose{});
    RayPacket rays;
    for (Index d = range.first; d < range.last; ++d) {
        if (!is_wanted(wanted, b * scene.sight.lines_per_patch() + d)) continue;
        of_block.rays(d, rays);
        const std::size_t line = scene.sight.line(block, d, 0);
        std::copy_n(background.distance.begin() + static_cast<std::ptrdiff_t>(line), block.count,
                    rays.far.begin());
        buffer.clear(rays);
        scene.actors.trace(rays, buffer);
        for (std::size_t lane = 0; lane < block.count; ++lane) {
            if (buffer.last(lane) < buffer.first(lane)) continue;
            const Index behind = background.patch[line + lane];
            put_events(static_cast<Index>(line + lane), behind, buffer.first(lane),
                       targets.of(buffer, lane, rays.ray(lane), furniture, behind), frames, part);
        }
    }
}

void find_own_in_block(const EventScene& scene, const LinesAlone& alone, std::size_t b,
                       const DirectionRange& range, TimeBuffer& buffer, Targets& targets, Part& part) {
    const int frames = scene.actors.frames().count();
    const PatchBlock& block = scene.sight.blocks()[b];
    const BlockLines of_block(scene.sight, b, Pose{});
    RayPacket rays;
    for (Index d = range.first; d < std::min(range.last, scene.sight.different_lines(block)); ++d) {
        of_block.rays(d, rays);
        const std::size_t at = LinesAlone::index(scene.sight, scene.mesh, block, d);
        std::copy_n(alone.lines().distance.begin() + static_cast<std::ptrdiff_t>(at), block.count,
                    rays.far.begin());
        buffer.clear(rays);
        scene.actors.trace_from(block.body, rays, buffer);
        for (std::size_t lane = 0; lane < block.count; ++lane) {
            if (buffer.last(lane) < buffer.first(lane)) continue;
            const Index behind = alone.lines().patch[at + lane];
            put_events(static_cast<Index>(scene.sight.line(block, d, static_cast<Index>(lane))), behind,
                       buffer.first(lane), targets.of(buffer, lane, rays.ray(lane), block.body, behind),
                       frames, part);
        }
    }
}

void find_light_in_block(const EventScene& scene, std::size_t b, const PacketMask& wanted,
                         HiddenFrames& hidden, Part& part) {
    const PatchBlock& block = scene.sight.blocks()[b];
    RayPacket rays;
    std::array<float, 16> unused;
    for (Index k = 0; k < scene.light.lines_per_patch(); ++k) {
        if (!is_wanted(wanted, b * scene.light.lines_per_patch() + k)) continue;
        if (scene.mesh.body[scene.light.lamp_patch(b, k)] != furniture) continue;
        scene.light.rays(b, k, scene.placed, rays, unused);
        const std::size_t line = scene.light.line(block, k, 0);
        for (std::size_t lane = 0; lane < block.count; ++lane)
            if (!(scene.background.light_contribution[line + lane] > 0)) rays.far[lane] = 0;
        hidden.clear(rays);
        scene.actors.trace(rays, hidden);
        for (std::size_t lane = 0; lane < block.count; ++lane) {
            if (!hidden.any(lane)) continue;
            hidden.for_changes(lane, [&](int frame, bool blocked) {
                part.push_back({frame,
                                {static_cast<Index>(line + lane), blocked ? lamp_open : lamp_hidden,
                                 blocked ? lamp_hidden : lamp_open}});
            });
        }
    }
}

}  // namespace

LineEvents find_line_events(const EventScene& scene, const DirectionRange& range, const PacketMask& wanted,
                            const Context& context) {
    check_size(scene.background.background.patch.size());
    return collect(scene, 0, scene.sight.static_blocks(), context,
                   [&](std::size_t begin, std::size_t end, Part& part) {
                       TimeBuffer buffer(scene.actors.frames().count());
                       Targets targets(scene);
                       for (std::size_t b = begin; b < end; ++b)
                           find_in_block(scene, b, range, wanted, buffer, targets, part);
                   });
}

bool can_look_ahead_along_own_lines(const SweptActors& actors, const FaceTree& furniture_tree) {
    return !actors.any_turns() && furniture_tree.faces.size() <= most_faces_of_furniture;
}

LineEvents find_own_line_events(const EventScene& scene, const LinesAlone& alone, const DirectionRange& range,
                                const Context& context) {
    check_size(std::size_t{scene.mesh.size()} * scene.sight.lines_per_patch());
    return collect(scene, scene.sight.static_blocks(), scene.sight.blocks().size(), context,
                   [&](std::size_t begin, std::size_t end, Part& part) {
                       TimeBuffer buffer(scene.actors.frames().count());
                       Targets targets(scene);
                       for (std::size_t b = begin; b < end; ++b)
                           find_own_in_block(scene, alone, b, range, buffer, targets, part);
                   });
}

LineEvents find_light_events(const EventScene& scene, const PacketMask& wanted, const Context& context) {
    check_size(scene.background.light_contribution.size());
    return collect(scene, 0, scene.sight.static_blocks(), context,
                   [&](std::size_t begin, std::size_t end, Part& part) {
                       HiddenFrames hidden(scene.actors.frames().count());
                       for (std::size_t b = begin; b < end; ++b)
                           find_light_in_block(scene, b, wanted, hidden, part);
                   });
}

}  // namespace afterglow
