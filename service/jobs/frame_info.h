#pragma once

#include <optional>

namespace afterglow {

/// A stored picture of a frame.
struct FrameInfo {
    int frame = 0;
    int revision = 0;  ///< counts from 1 within its frame
    bool final = false;
    double residual = 0;                       ///< as in FrameStatistics
    std::optional<double> error_bound;         ///< the certificate; known for final pictures only
    std::optional<double> picture_error = {};  ///< of final pictures, where it was asked for
    double seconds = 0;                        ///< wall time that the frame took, of final pictures
};

}  // namespace afterglow
