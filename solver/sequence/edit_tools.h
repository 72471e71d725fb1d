#pragma once

#include "solver/scene/named.h"
#include "solver/sequence/edits.h"
#include "solver/sequence/parts.h"

namespace afterglow {

/// A strategy that knows nothing yet.
void renew_strategy(SequenceState::Parts& parts);

/// What is known of lines that move, of light and of the picture is of no more use.
void forget_solution(SequenceState::Parts& parts);

/// What followed from frame to frame, lines' backgrounds apart, is of no more use.
void forget_frames(SequenceState::Parts& parts);

/// Everything but the scene itself, from the beginning. Errors: cancelled, which leaves all as it was.
EditOutcome begin_anew(SequenceState::Parts& parts, const Context& context);

}  // namespace afterglow
