#include "solver/visibility/events.h"

#include <algorithm>
#include <optional>

#include "solver/base/error.h"
#include "solver/visibility/line_events.h"
#include "solver/visibility/own_light_lines.h"
#include "solver/visibility/own_lines.h"

namespace afterglow {

namespace {

/// The events of some frames, by the ranges of directions in which they were asked for.
struct Window {
    SweptActors actors;
    std::vector<LineEvents> sight;
    LineEvents light;
    Index directions = 0;  ///< of every patch; 0: the light lines are missing, too
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
    }

    [[nodiscard]] bool needs_background() const override { return true; }
    [[nodiscard]] std::span<const WorkAhead> work_ahead() const override { return work_ahead_; }

    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override {
        if (!window_ || !window_->actors.frames().contains(scene.frame))
            open_window(scene.frame);
        else if (shown_ && *shown_ != scene.frame)
            move_to(scene, visible);
        if (range.last > window_->directions) extend(scene, range.last, visible, context);
        shown_ = scene.frame;
        std::uint64_t rays = own_.update(scene, range, visible, context);
        if (range.first == 0) rays += own_light_.update(scene, visible, context);
        return rays;
    }

  private:
    /// Windows begin at multiples of their length, so that neighbouring frames share one from either side.
    void open_window(int frame) {
        const int first = frame - frame % config_.frames_per_window;
        window_.emplace(Window{
            SweptActors(world_, trees_, clock_, {first, first + config_.frames_per_window - 1}), {}, {}, 0});
        shown_.reset();
    }

    /// Frame by frame from the one shown to the one asked for.
    void move_to(const LineScene& scene, VisibleLines& visible) {
        const int first = window_->actors.frames().first;
        for (int f = *shown_ + 1; f <= scene.frame; ++f) show_all(f - first, &LineEvent::to, scene, visible);
        for (int f = *shown_; f > scene.frame; --f) show_all(f - first, &LineEvent::from, scene, visible);
    }

    /// Shows one side of a frame's events: what they lead to or, to go back, what they come from.
    using Shown = Index LineEvent::*;
    void show_all(int f, Shown shown, const LineScene& scene, VisibleLines& visible) const {
        for (const LineEvents& events : window_->sight) show_patches(events.at(f), shown, visible);
        show_lamps(window_->light.at(f), shown, scene, visible);
    }
    static void show_patches(std::span<const LineEvent> events, Shown shown, VisibleLines& visible) {
        for (const LineEvent& event : events) visible.patch[event.line] = event.*shown;
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
        // Left for good only once all is done: a stop in the middle leaves no half-known window.
        Window window = std::move(*window_);
        window_.reset();
        const EventScene events{world_,           scene.mesh,    scene.sight, scene.light,
                                scene.background, window.actors, scene.caster};
        const bool first_time = window.directions == 0;
        const DirectionRange range{window.directions, last};
        if (first_time) window.light = find_light_events(events, context);
        window.sight.push_back(find_line_events(events, range, context));
        window.directions = last;

        show_background(scene, range, visible);
        if (first_time)
            std::copy(scene.background.light_contribution.begin(), scene.background.light_contribution.end(),
                      visible.light_contribution.begin());
        const FrameSpan frames = window.actors.frames();
        for (int f = 0; f <= scene.frame - frames.first; ++f) {
            show_patches(window.sight.back().at(f), &LineEvent::to, visible);
            if (first_time) show_lamps(window.light.at(f), &LineEvent::to, scene, visible);
        }
        window_.emplace(std::move(window));
        note(frames, watch.elapsed());
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
    std::optional<int> shown_;  ///< the frame that all known directions are at
    std::vector<WorkAhead> work_ahead_;
    OwnLines own_;
    OwnLightLines own_light_;
};

}  // namespace

std::unique_ptr<VisibilityStrategy> make_events(const World& world, const FrameClock& clock,
                                                const EventsConfig& config) {
    auto events = std::make_unique<Events>(world, clock, config);
    if (!anything_moves(world)) return make_back_buffer(world, clock);
    return events;
}

}  // namespace afterglow
