#pragma once

#include <optional>

namespace afterglow {

/// A stored picture of a frame.
struct FrameInfo {
    int frame = 0;
    int revision = 0;  ///< counts from 1 within its frame, see revision_of_picture
    bool final = false;
    double residual = 0;                       ///< as in FrameStatistics
    std::optional<double> error_bound;         ///< the certificate; known for final pictures only
    std::optional<double> picture_error = {};  ///< of final pictures, where it was asked for
    double seconds = 0;                        ///< wall time that the frame took, of final pictures
    int job_revision = 0;                      ///< of the job that it shows, see Job::revision
};

/// The number under which a picture is known that is the `revision`-th of its frame in a run of a job that
/// has been edited `job_revision` times: it grows with every edit, so that what was sent under a number stays
/// so. No frame comes near a thousand pictures.
inline int revision_of_picture(int job_revision, int revision) {
    return 1000 * job_revision + revision;
}

}  // namespace afterglow
