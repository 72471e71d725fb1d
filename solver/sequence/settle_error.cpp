#include "solver/sequence/settle_error.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "solver/base/error.h"
#include "solver/sequence/asked_error.h"
#include "solver/sequence/choose.h"
#include "solver/sequence/edit_tools.h"
#include "solver/sequence/frame_refinement.h"
#include "solver/sequence/quality.h"

namespace afterglow {

namespace {

// A little more than asked is not worth everything being made twice.
constexpr double hardly_above = 1.1;
// What is made again should come to this share of what was asked.
constexpr double aim = 0.8;
// Halvings of the square of an error at once: further on, too little is known, and what is made for half the
// error takes four times as long.
constexpr double most_steps = 2;
// What gains less is not worth everything being made again.
constexpr double least_gain = 0.85;

double upper(const ProbeEstimate& estimate) {
    return estimate.relative_error + estimate.standard_error;
}

void warn_of_large_error(SequenceState::Parts& parts, const ProbeEstimate& estimate) {
    std::ostringstream text;
    text.precision(2);
    text << "may not be kept: the picture of time 0 is estimated at " << 100 * estimate.relative_error
         << " %, one standard error above that is " << 100 * upper(estimate) << " %";
    parts.warnings.push_back({"error", text.str()});
}

/// Divides the world anew. A stop leaves it as it was, and so does what takes too many patches: then false.
bool make_finer(SequenceState::Parts& parts, double error, const Context& context) {
    const auto before = std::exchange(parts.config.asked_error, error);
    try {
        begin_anew(parts, context);
        return true;
    } catch (const Error& failed) {
        parts.config.asked_error = before;
        if (failed.kind() == ErrorKind::too_large) return false;
        throw;
    } catch (...) {
        parts.config.asked_error = before;
        throw;
    }
}

/// Pictures of time 0 until one is near enough, with nothing kept from before. Returns what they cost.
FrameStatistics settle_with_pictures(SequenceState::Parts& parts, const Context& context) {
    FrameStatistics cost;
    for (double done = 0; is_to_be_settled(parts); done = (1 + done) / 2) {
        const Context stage = context.part(done, (1 + done) / 2);
        // Nothing is sought ahead for a frame that may never be shown. All strategies see the same.
        const bool has_background =
            parts.strategy->needs_background() || parts.config.solution == Solution::residual;
        const auto strategy = make_strategy(has_background ? Visibility::back_buffer : Visibility::retrace,
                                            parts.world, parts.clock());
        FrameRefinement frame(parts, 0);
        frame.add_cost(cost);
        frame.look(parts.sight->lines_per_patch(), *strategy, stage);
        frame.solve_finally(level_of(parts.config).certificate, stage);
        const Picture picture = frame.final_picture(stage);
        const ProbeEstimate estimate = frame.probe(picture, stage);
        cost = frame.statistics();
        settle_error(parts, estimate, stage.part(settled_at, 1));
    }
    return cost;
}

}  // namespace

double error_to_make_for(double asked, double made_for, const ProbeEstimate& estimate) {
    if (upper(estimate) <= hardly_above * asked) return made_for;
    // Where probes disagree by more than they tell, that is all there is to go by.
    const double likely = std::max(estimate.relative_error, estimate.standard_error);
    const double over = std::max(likely / (aim * asked), 1.0);
    const double steps = std::clamp(std::ceil(2 * std::log2(over)), 1.0, most_steps);
    const double before = std::min(made_for, coarsest_error);
    const double finer = std::max(before * std::exp2(-0.5 * steps), finest_promised_error);
    return finer < least_gain * before ? finer : made_for;
}

void begin_settling(SequenceState::Parts& parts) {
    if (!error_settles_all(parts.config)) return;
    parts.statistics.made_for_error = parts.config.made_for_error;
    if (parts.config.made_for_error)
        parts.config.asked_error = parts.config.made_for_error;
    else
        parts.settling = Settling{.asked = *parts.config.asked_error};
}

bool is_to_be_settled(const SequenceState::Parts& parts) {
    return parts.settling.has_value();
}

bool settle_error(SequenceState::Parts& parts, const ProbeEstimate& estimate, const Context& context) {
    const double asked = parts.settling->asked, made_for = *parts.config.asked_error;
    const double finer = error_to_make_for(asked, made_for, estimate);
    if (finer < made_for && parts.settling->tries_left > 0 && make_finer(parts, finer, context)) {
        --parts.settling->tries_left;
        return true;
    }
    parts.settling.reset();
    parts.statistics.made_for_error = made_for;
    if (upper(estimate) > hardly_above * asked) warn_of_large_error(parts, estimate);
    return false;
}

FrameStatistics settle_error_at_start(SequenceState::Parts& parts, const Context& context) {
    forget_frames(parts);
    try {
        const FrameStatistics cost = settle_with_pictures(parts, context);
        forget_frames(parts);
        return cost;
    } catch (...) {
        forget_frames(parts);
        throw;
    }
}

}  // namespace afterglow
