#pragma once

#include <string>

#include "solver/sequence/edits.h"

namespace afterglow {

// Edits of the furniture in a running job, between two steps, by the names of its pieces: those of the static
// nodes of a scene. What comes after is what a new job on the edited scene would give, but for the noise of
// lines near the change: patches that are new go by other directions. Patches elsewhere keep number and
// lines; a line that met neither the old place nor the new one up to what it saw keeps its background, and
// only the others are traced. Light that is kept as residual starts from what these patches shone with, other
// light anew. The size of patches stays what it was, where quality settles it. Errors of all: not_found,
// listing the pieces there are; invalid_input naming the value; cancelled. Nothing is changed then, but much
// is to be computed again. One thread at a time.

/// Moves a piece by a rigid motion from where it stands, in world coordinates. Errors: also invalid_input,
/// "motion", where it is not finite or its rotation not of unit length.
EditOutcome move_furniture(SequenceState& state, const std::string& piece, const Pose& motion,
                           const Context& context);

/// Takes a piece away.
EditOutcome remove_furniture(SequenceState& state, const std::string& piece, const Context& context);

/// Adds an object, see add_piece: positions in world coordinates, materials those of the scene.
EditOutcome add_furniture(SequenceState& state, const Body& object, const Context& context);

}  // namespace afterglow
