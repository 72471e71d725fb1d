#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/base/stopwatch.h"
#include "solver/visibility/motion.h"
#include "solver/visibility/static_pass.h"

namespace afterglow {

/// What every line of every patch sees at one time.
struct VisibleLines {
    std::vector<Index> patch;               ///< by sight line: patch, sees_nothing or sees_inside
    std::vector<float> light_contribution;  ///< by light line, 0 where blocked
};
VisibleLines make_visible_lines(const PatchMesh& mesh, const SightLines& sight, const LightLines& light);

/// A sight line of a static patch that came to see something else.
struct LineChange {
    Index line = 0;
    Index from = 0, to = 0;  ///< patch, sees_nothing or sees_inside
    bool operator==(const LineChange&) const = default;
};

/// Which lines of static patches changed, in the order in which they did.
struct LineChanges {
    std::vector<LineChange> sight;
    std::vector<Index> light;  ///< light lines that an actor came to cover or left; may name one twice
};

/// The lines and what they are traced in, the caster's bodies standing where they are at this time.
struct LineScene {
    const PatchMesh& mesh;
    const SightLines& sight;
    const LightLines& light;
    const RayCaster& caster;
    const StaticLines& background;  ///< traced as far as asked for; used by strategies that say they need it
    int frame = 0;                  ///< which frame the poses stand for
};

/// What a strategy did for a range of frames at once, when the first of them was asked for.
struct WorkAhead {
    FrameSpan frames;
    Milliseconds time{};
};

/// The time of all of it.
Milliseconds total(std::span<const WorkAhead> work);

/// How a frame learns what its lines see. All strategies give the same answers; they differ in work.
/// A strategy may keep what it knows from one frame for the next. One thread at a time.
class VisibilityStrategy {
  public:
    virtual ~VisibilityStrategy() = default;
    /// Whether LineScene::background must have been traced.
    [[nodiscard]] virtual bool needs_background() const = 0;
    /// Brings a range of sight lines up to date, and the light lines with the range that starts at 0.
    /// `visible` must be given back as the call before left it: what stays as it was is not written again.
    /// Returns the number of rays. Errors: cancelled.
    virtual std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                                 const Context& context) = 0;
    /// What the updates since the last call changed on static patches' lines, where the strategy knows it
    /// without comparing.
    [[nodiscard]] virtual std::optional<LineChanges> take_changes() { return std::nullopt; }
    /// Takes over that the world has one actor go another way than `before`; its other ways and all lines are
    /// as they were. Returns which share of the lines known ahead stays known, or nothing where the strategy
    /// is to be made anew. `visible` may then be shown otherwise by the next update. Errors: cancelled,
    /// after which nothing is known ahead.
    virtual std::optional<double> follow_path(const LineScene& scene, Index actor, const Path& before,
                                              const Context& context);
    /// Window by window, in order of time spent. Not part of any one frame's cost.
    [[nodiscard]] virtual std::span<const WorkAhead> work_ahead() const { return {}; }
};

/// Static and moving geometry traced anew: the yardstick and the oracle.
std::unique_ptr<VisibilityStrategy> make_retrace();

/// Static receivers keep their backgrounds; lines that meet an actor's box now are traced against it, see
/// back_buffer.h. `clock` tells what LineScene::frame means. Source: Baum et al. 1986.
std::unique_ptr<VisibilityStrategy> make_back_buffer(const World& world, const FrameClock& clock);

/// Static lines keep their backgrounds; groups of patches keep a temporal graph of the actors between them
/// and follow it front to back, see temporal_graph_strategy.h. Where nothing ever moves there is nothing to
/// follow: then it is `back-buffer`. `clock` tells what LineScene::frame means. Source: Tost and Pueyo 1993,
/// section 3.
std::unique_ptr<VisibilityStrategy> make_temporal_graph(const World& world, const FrameClock& clock);

}  // namespace afterglow
