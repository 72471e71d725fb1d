#pragma once

#include "solver/image/probes.h"
#include "solver/sequence/parts.h"

// An asked error held against a picture. Tables know what most scenes need (see level_for_error); in some,
// light comes from few small bright places, and lines and samples that are enough elsewhere are not. So the
// picture of time 0 is probed, and where it seems farther off than asked everything is made finer.

namespace afterglow {

/// The error to make pictures for, where one made for `made_for` was estimated so: `made_for` where one
/// standard error above the estimate is hardly above `asked`, else smaller by √2 or 2, so that estimates
/// which differ a little lead to the same. All in (0, 1). Not below what tables promise, and `made_for` again
/// where that leaves next to nothing to gain. Thread-safety: pure.
double error_to_make_for(double asked, double made_for, const ProbeEstimate& estimate);

/// Where probing ends in a picture's progress: what comes after is settle_error's.
inline constexpr double settled_at = 0.95;

/// To be called before the world is meshed: takes what settings know of it, or leaves the question open.
void begin_settling(SequenceState::Parts& parts);

/// Whether the picture of time 0 has still to be probed: only where the asked error settles all, until it is
/// found near enough or was made again, and probed again, twice.
bool is_to_be_settled(const SequenceState::Parts& parts);

/// Takes what probes say of the picture of time 0. Where that is too far off, divides the world into finer
/// patches, lays their lines, forgets what was solved and returns true: the picture is to be made again.
/// Where that takes more patches than there may be, it is as if nothing finer were known. A job whose
/// pictures may stay farther off than asked gets a warning. Errors: cancelled, which leaves the question
/// open.
bool settle_error(SequenceState::Parts& parts, const ProbeEstimate& estimate, const Context& context);

/// The same for a job that begins with another frame, so that parts of an animation computed apart by the
/// same method fit together: makes pictures of time 0 until it is settled. Returns what they cost. Errors:
/// cancelled, which leaves the question open; cannot_converge.
FrameStatistics settle_error_at_start(SequenceState::Parts& parts, const Context& context);

}  // namespace afterglow
