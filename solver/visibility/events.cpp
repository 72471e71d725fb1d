#include "solver/visibility/events.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "solver/base/error.h"
#include "solver/visibility/changed_events.h"
#include "solver/visibility/own_light_lines.h"
#include "solver/visibility/own_lines.h"

namespace afterglow {

namespace {

// How much longer each window is than the one before it: work that is done once a window whatever its length
// soon does not count, and no frame but the first few waits much longer than those before it.
constexpr int growth = 4;
constexpr std::size_t events_per_chunk = 8192;

/// The events of some frames, by the ranges of directions in which they were asked for.
struct Window {
    SweptActors actors;
    std::vector<DirectionRange> ranges;
    std::vector<LineEvents> sight;  ///< by range
    std::vector<LineEvents> own;    ///< likewise, of actors' own lines, where they can be looked ahead along
    LineEvents light;
    bool looks_along_own = false;  ///< ahead, that is
    Index directions = 0;          ///< of every patch; 0: the light lines are missing, too
};

class Events : public VisibilityStrategy {
  public:
    Events(const World& world, const FrameClock& clock, const EventsConfig& config)
        : world_(world),
          trees_(make_actor_trees(world)),
          clock_(clock),
          config_(config),
          own_(world),
          own_light_(world) {
        if (config.frames_per_window < 1 || config.frames_per_window > 4096)
            throw Error(ErrorKind::invalid_input, "frames_per_window", "must be 1 to 4096");
        if (config.frames_of_first_window < 1)
            throw Error(ErrorKind::invalid_input, "frames_of_first_window", "must be 1 or more");
        trees_[furniture] = make_face_tree(world.bodies[furniture]);
    }

    [[nodiscard]] bool needs_background() const override { return true; }
    [[nodiscard]] std::span<const WorkAhead> work_ahead() const override { return work_ahead_; }

    [[nodiscard]] std::optional<LineChanges> take_changes() override {
        const bool known = std::exchange(changes_known_, true);
        LineChanges taken = std::exchange(changes_, {});
        if (!known) return std::nullopt;
        return taken;
    }

    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override {
        if (!window_ || !window_->actors.frames().contains(scene.frame))
            open_window(scene.frame);
        else if (!shown_)
            show_again(scene, visible);
        else if (*shown_ != scene.frame)
            move_to(scene, visible, context);
        if (range.last > window_->directions) extend(scene, range.last, visible, context);
        shown_ = scene.frame;
        std::uint64_t rays = window_->looks_along_own ? 0 : own_.update(scene, range, visible, context);
        if (range.first == 0) rays += own_light_.update(scene, visible, context);
        return rays;
    }

    std::optional<double> follow_path(const LineScene& scene, Index actor, const Path& before,
                                      const Context& context) override {
        if (!anything_moves(world_)) return std::nullopt;
        forget_changes();
        if (!window_) return 0;
        const Stopwatch watch;
        shown_.reset();
        // As in extend.
        Window window = std::move(*window_);
        window_.reset();
        std::vector<Box> boxes = window.actors.boxes_of(actor);
        const FrameSpan frames = window.actors.frames();
        const bool same_here = goes_as(before, actor, frames);
        window.actors = SweptActors(world_, trees_, clock_, frames);
        double kept = 1;
        if (!same_here) {
            const auto now = window.actors.boxes_of(actor);
            boxes.insert(boxes.end(), now.begin(), now.end());
            kept = find_again(scene, boxes, window, context);
        }
        window_.emplace(std::move(window));
        note(frames, watch.elapsed());
        return kept;
    }

  private:
    /// Whether an actor stands in some frames where it stood on another path.
    [[nodiscard]] bool goes_as(const Path& before, Index actor, const FrameSpan& frames) const {
        for (int f = frames.first; f <= frames.last; ++f)
            if (before.at(clock_.time_of(f)) != world_.bodies[actor].path.at(clock_.time_of(f))) return false;
        return true;
    }

    /// Finds the events of those packets anew that meet some boxes; returns the share of the others.
    double find_again(const LineScene& scene, std::span<const Box> boxes, Window& window,
                      const Context& context) {
        const EventScene events{world_,           scene.mesh,    scene.sight, scene.light,
                                scene.background, window.actors, scene.caster};
        find_own_again(events, scene, window, context);
        std::size_t met = 0, all = 0;
        const auto count = [&](const MetPackets& packets) {
            met += packets.met;
            all += packets.all;
        };
        for (std::size_t r = 0; r < window.ranges.size(); ++r) {
            const DirectionRange& range = window.ranges[r];
            const MetPackets packets = sight_packets_meeting(events, range, boxes, context);
            window.sight[r] =
                replace_events(scene.sight, scene.sight.lines_per_patch(), window.sight[r], packets.mask,
                               find_line_events(events, range, packets.mask, context));
            count(packets);
        }
        if (scene.light.lines_per_patch() > 0) {
            const MetPackets packets = light_packets_meeting(events, boxes, context);
            window.light = replace_events(scene.sight, scene.light.lines_per_patch(), window.light,
                                          packets.mask, find_light_events(events, packets.mask, context));
            count(packets);
        }
        return all > 0 ? 1 - static_cast<double>(met) / static_cast<double>(all) : 0;
    }

    /// Of actors' own lines all events, which are few: any of them may meet the actor.
    void find_own_again(const EventScene& events, const LineScene& scene, Window& window,
                        const Context& context) {
        window.own.clear();
        window.looks_along_own = can_look_ahead_along_own_lines(window.actors, trees_[furniture]);
        if (!window.looks_along_own) return;
        learn_alone(scene, window.directions, context);
        for (const DirectionRange& range : window.ranges)
            window.own.push_back(find_own_line_events(events, alone_, range, context));
    }

    void open_window(int frame) {
        if (!start_) start_ = frame;
        window_.emplace(Window{
            SweptActors(world_, trees_, clock_, event_window(frame, *start_, config_)), {}, {}, {}, {}});
        window_->looks_along_own = can_look_ahead_along_own_lines(window_->actors, trees_[furniture]);
        shown_.reset();
        forget_changes();
    }
    /// What the lines are brought to next has nothing to do with what they showed before.
    void forget_changes() {
        changes_ = {};
        changes_known_ = false;
    }

    /// Frame by frame from the one shown to the one asked for.
    void move_to(const LineScene& scene, VisibleLines& visible, const Context& context) {
        // A stop in the middle leaves lines of which nobody knows what they show.
        const int shown = *std::exchange(shown_, std::nullopt);
        auto changes = take_changes();
        changes_known_ = false;
        const int first = window_->actors.frames().first;
        for (int f = shown + 1; f <= scene.frame; ++f)
            pass(f - first, &LineEvent::from, &LineEvent::to, scene, visible, changes, context);
        for (int f = shown; f > scene.frame; --f)
            pass(f - first, &LineEvent::to, &LineEvent::from, scene, visible, changes, context);
        changes_known_ = changes.has_value();
        if (changes) changes_ = std::move(*changes);
    }

    using Shown = Index LineEvent::*;
    /// Passes a frame's events, from one side to the other, and adds what changes where that is asked for.
    void pass(int f, Shown from, Shown to, const LineScene& scene, VisibleLines& visible,
              std::optional<LineChanges>& changes, const Context& context) const {
        for (const LineEvents& range : window_->sight) {
            const std::span<const LineEvent> events = range.at(f);
            const std::size_t before = changes ? changes->sight.size() : 0;
            if (changes) changes->sight.resize(before + events.size());
            // No line has two events in a frame.
            context.for_chunks(events.size(), events_per_chunk, [&](std::size_t begin, std::size_t end) {
                show_patches(events.subspan(begin, end - begin), to, visible);
                for (std::size_t k = begin; changes && k < end; ++k)
                    changes->sight[before + k] = {events[k].line, events[k].*from, events[k].*to};
            });
        }
        for (const LineEvents& events : window_->own) show_own(events.at(f), to, scene, visible);
        show_lamps(window_->light.at(f), to, scene, visible);
        for (const LineEvent& event : window_->light.at(f))
            if (changes) changes->light.push_back(event.line);
    }
    static void show_patches(std::span<const LineEvent> events, Shown shown, VisibleLines& visible) {
        for (const LineEvent& event : events) visible.patch[event.line] = event.*shown;
    }
    /// Lines that are one and the same see the same.
    static void show_own(std::span<const LineEvent> events, Shown shown, const LineScene& scene,
                         VisibleLines& visible) {
        const SightLines& sight = scene.sight;
        auto block = sight.blocks().begin() + static_cast<std::ptrdiff_t>(sight.static_blocks());
        for (const LineEvent& event : events) {
            while (event.line >= sight.line(*block, sight.lines_per_patch(), 0)) ++block;
            const std::size_t next = std::size_t{sight.different_lines(*block)} * block->count;
            for (std::size_t line = event.line; line < sight.line(*block, sight.lines_per_patch(), 0);
                 line += next)
                visible.patch[line] = event.*shown;
        }
    }
    static void show_lamps(std::span<const LineEvent> events, Shown shown, const LineScene& scene,
                           VisibleLines& visible) {
        for (const LineEvent& event : events)
            visible.light_contribution[event.line] =
                event.*shown == lamp_open ? scene.background.light_contribution[event.line] : 0.0F;
    }

    /// Finds the events of directions up to `last` and shows those directions at the frame asked for.
    void extend(const LineScene& scene, Index last, VisibleLines& visible, const Context& context) {
        const Stopwatch watch;
        forget_changes();
        // Left for good only once all is done: a stop in the middle leaves no half-known window.
        Window window = std::move(*window_);
        window_.reset();
        const EventScene events{world_,           scene.mesh,    scene.sight, scene.light,
                                scene.background, window.actors, scene.caster};
        const bool first_time = window.directions == 0;
        const DirectionRange range{window.directions, last};
        if (first_time) window.light = find_light_events(events, {}, context);
        window.ranges.push_back(range);
        window.sight.push_back(find_line_events(events, range, {}, context));
        if (window.looks_along_own) {
            learn_alone(scene, last, context);
            window.own.push_back(find_own_line_events(events, alone_, range, context));
        }
        window.directions = last;
        window_.emplace(std::move(window));
        show_sight(scene, window_->ranges.size() - 1, visible);
        if (first_time) show_light(scene, visible);
        note(window_->actors.frames(), watch.elapsed());
    }

    /// Shows all that is known at the frame asked for, whatever was shown before.
    void show_again(const LineScene& scene, VisibleLines& visible) const {
        for (std::size_t r = 0; r < window_->ranges.size(); ++r) show_sight(scene, r, visible);
        if (!window_->ranges.empty()) show_light(scene, visible);
    }
    void show_sight(const LineScene& scene, std::size_t range, VisibleLines& visible) const {
        show_background(scene, window_->ranges[range], visible);
        if (window_->looks_along_own) show_alone(scene, window_->ranges[range], visible);
        for (int f = 0; f <= scene.frame - window_->actors.frames().first; ++f) {
            show_patches(window_->sight[range].at(f), &LineEvent::to, visible);
            if (window_->looks_along_own) show_own(window_->own[range].at(f), &LineEvent::to, scene, visible);
        }
    }
    void show_light(const LineScene& scene, VisibleLines& visible) const {
        std::copy(scene.background.light_contribution.begin(), scene.background.light_contribution.end(),
                  visible.light_contribution.begin());
        for (int f = 0; f <= scene.frame - window_->actors.frames().first; ++f)
            show_lamps(window_->light.at(f), &LineEvent::to, scene, visible);
    }

    static void show_background(const LineScene& scene, const DirectionRange& range, VisibleLines& visible) {
        for (std::size_t b = 0; b < scene.sight.static_blocks(); ++b) {
            const PatchBlock& block = scene.sight.blocks()[b];
            const auto first = static_cast<std::ptrdiff_t>(scene.sight.line(block, range.first, 0));
            const auto last = static_cast<std::ptrdiff_t>(scene.sight.line(block, range.last, 0));
            std::copy(scene.background.background.patch.begin() + first,
                      scene.background.background.patch.begin() + last, visible.patch.begin() + first);
        }
    }

    void learn_alone(const LineScene& scene, Index last, const Context& context) {
        const std::size_t first = scene.sight.static_blocks();
        alone_.reserve(scene.sight, scene.mesh);
        context.for_chunks(scene.sight.blocks().size() - first, 1, [&](std::size_t begin, std::size_t) {
            alone_.extend(scene.sight, scene.mesh, scene.caster, first + begin, last);
        });
    }
    void show_alone(const LineScene& scene, const DirectionRange& range, VisibleLines& visible) const {
        for (std::size_t b = scene.sight.static_blocks(); b < scene.sight.blocks().size(); ++b) {
            const PatchBlock& block = scene.sight.blocks()[b];
            const Index different = scene.sight.different_lines(block);
            const auto lines = [&](Index d) {
                return visible.patch.begin() + static_cast<std::ptrdiff_t>(scene.sight.line(block, d, 0));
            };
            for (Index d = range.first; d < range.last; ++d) {
                // Those shown already are where they should be, and the others follow them.
                const std::size_t at = LinesAlone::index(scene.sight, scene.mesh, block, d % different);
                if (d % different < range.first)
                    std::copy_n(lines(d % different), block.count, lines(d));
                else
                    std::copy_n(alone_.lines().patch.begin() + static_cast<std::ptrdiff_t>(at), block.count,
                                lines(d));
            }
        }
    }

    void note(const FrameSpan& frames, Milliseconds time) {
        if (work_ahead_.empty() || work_ahead_.back().frames != frames)
            work_ahead_.push_back({frames, time});
        else
            work_ahead_.back().time += time;
    }

    const World& world_;
    ActorTrees trees_;
    FrameClock clock_;
    EventsConfig config_;
    std::optional<Window> window_;
    std::optional<int> start_;  ///< the first frame asked for
    std::optional<int> shown_;  ///< the frame that all known directions are at
    std::vector<WorkAhead> work_ahead_;
    bool changes_known_ = false;  ///< since somebody first asked, unless lines were brought anywhere at once
    LineChanges changes_;
    OwnLines own_;
    LinesAlone alone_;
    OwnLightLines own_light_;
};

}  // namespace

FrameSpan event_window(int frame, int start, const EventsConfig& config) {
    const int full = config.frames_per_window;
    if (frame < start) {
        const int last = start - 1 - (start - 1 - frame) / full * full;
        return {std::max(0, last - full + 1), last};
    }
    int first = start, count = std::min(config.frames_of_first_window, full);
    for (; count < full && frame >= first + count; count = std::min(growth * count, full)) first += count;
    first += (frame - first) / count * count;
    return {first, first + count - 1};
}

std::unique_ptr<VisibilityStrategy> make_events(const World& world, const FrameClock& clock,
                                                const EventsConfig& config) {
    auto events = std::make_unique<Events>(world, clock, config);
    if (!anything_moves(world)) return make_back_buffer(world, clock);
    return events;
}

}  // namespace afterglow
