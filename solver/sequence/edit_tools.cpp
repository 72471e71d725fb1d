#include "solver/sequence/edit_tools.h"

#include "solver/sequence/choose.h"
#include "solver/sequence/prepare.h"

namespace afterglow {

void forget_frames(SequenceState::Parts& parts) {
    parts.edited = true;
    parts.kept_light.reset();
    parts.radiosity_before.clear();
    parts.kept_rows.reset();
    parts.picture = {};
    parts.visible_before.clear();
    parts.strategy = make_strategy(parts.config.visibility, parts.world, parts.clock());
}

EditOutcome begin_anew(SequenceState::Parts& parts, const Context& context) {
    parts.background = {};
    parts.guessed_size_m.reset();
    parts.patch_size_m.reset();
    mesh_world(parts, context);
    forget_frames(parts);
    return {0, 0, false};
}

}  // namespace afterglow
