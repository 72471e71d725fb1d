#pragma once

#include "solver/sequence/quality.h"

// What a picture of an asked error is made with.

namespace afterglow {

/// The smallest relative error that `level_for_error` was measured to keep. Below it patches and samples
/// still grow, by the slopes measured above it and up to a bound, but what comes out is not promised.
inline constexpr double finest_promised_error = 0.007;

/// Errors above it are given what it needs: coarser patches save nothing that shows.
inline constexpr double coarsest_error = 0.10;

/// Whether the asked error settles patches, lines and samples, and not the certificate alone: where neither
/// lines nor patches are given. Thread-safety: pure.
bool error_settles_all(const SequenceConfig& config);

/// The cheapest patches, lines and samples known to keep a picture's relative root mean square error at or
/// below `asked`, in (0, 1), of a picture of that many pixels. Between measured ones, all numbers are
/// interpolated as powers of the error. Edges take a share of a picture that goes with the inverse of its
/// own edge, so below the size that was measured pixels with edges get more samples.
/// Its picture's and probes' seeds are left as they are. Thread-safety: pure. Source: measured, see
/// README.md.
QualityLevel level_for_error(double asked, double pixels);

}  // namespace afterglow
