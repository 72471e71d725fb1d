#pragma once

#include <string>

#include "solver/sequence/sequence.h"

namespace afterglow {

/// What an edit leaves of what a job has worked out.
struct EditOutcome {
    /// Of all lines of static patches, those whose background stays known.
    double lines_reused = 1;
    /// Of the lines looked ahead along for frames to come, those for which what happens stays known; 0 where
    /// nothing was known.
    double ahead_reused = 0;
    /// Whether the next frame's light starts from the last one's.
    bool light_reused = true;
};

// Edits of a running job, between two steps. What comes after is, within its certificate, what a new job on
// the edited scene would give; frames shown before are not touched. Names are those of the scene. Errors of
// all: not_found, listing the names there are; invalid_input naming the value; nothing is changed then. One
// thread at a time.

/// What a material emits, W/m²/sr, from now on at all times: its track, if any, is dropped. Where another
/// surface comes to count as a lamp, light lines are laid and traced anew; where light comes to sides that it
/// never reached, everything is.
EditOutcome set_emission(SequenceState& state, const std::string& material, const Rgb& emission,
                         const Context& context);

/// How strongly the lamps without surface of a name shine, W/sr per channel in [0, 1e6), directional ones
/// W/m², from now on. All lines stay, and light follows: what a lamp can reach does not depend on its
/// strength.
EditOutcome set_intensity(SequenceState& state, const std::string& lamp, const Rgb& intensity);

/// What share of light a material reflects, each channel in [0, 1), likewise.
EditOutcome set_reflectance(SequenceState& state, const std::string& material, const Rgb& reflectance);

/// Where an actor goes from a time on: keys of `path` before it are left out, and so are those of its old
/// path from then on. The furniture's backgrounds stay, unless light comes to sides that it never reached;
/// what was known of the actors ahead is found anew along lines that come near the actor on its old way or
/// the new one.
EditOutcome set_path(SequenceState& state, const std::string& actor, double from_s, const Path& path,
                     const Context& context);

/// Where the picture is taken from. Light and lines stay.
EditOutcome set_camera(SequenceState& state, const PlacedCamera& camera);

}  // namespace afterglow
