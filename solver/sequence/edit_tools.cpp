#include "solver/sequence/edit_tools.h"

#include <tuple>
#include <utility>

#include "solver/sequence/choose.h"
#include "solver/sequence/prepare.h"

namespace afterglow {

void renew_strategy(SequenceState::Parts& parts) {
    const auto ahead = parts.strategy->work_ahead();
    parts.earlier_work_ahead.insert(parts.earlier_work_ahead.end(), ahead.begin(), ahead.end());
    parts.strategy = make_strategy(parts.config.visibility, parts.world, parts.clock());
}

void forget_solution(SequenceState::Parts& parts) {
    renew_strategy(parts);
    parts.kept_light.reset();
    parts.kept_rows.reset();
    parts.picture = {};
}

void forget_frames(SequenceState::Parts& parts) {
    forget_solution(parts);
    parts.radiosity_before.clear();
    parts.visible_before.clear();
}

EditOutcome begin_anew(SequenceState::Parts& parts, const Context& context) {
    const auto sizes = std::pair(parts.guessed_size_m, parts.patch_size_m);
    const SideMask reached = parts.reached;
    parts.guessed_size_m.reset();
    parts.patch_size_m.reset();
    try {
        divide_world(parts, context);
    } catch (...) {
        std::tie(parts.guessed_size_m, parts.patch_size_m) = sizes;
        parts.reached = reached;
        throw;
    }
    parts.background = {};
    lay_lines(parts);
    forget_frames(parts);
    return {0, 0, false};
}

}  // namespace afterglow
