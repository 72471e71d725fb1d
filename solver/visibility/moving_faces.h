#pragma once

#include "solver/visibility/face_tree.h"
#include "solver/visibility/hidden_frames.h"
#include "solver/visibility/motion.h"
#include "solver/visibility/time_buffer.h"

namespace afterglow {

/// One body that moves by the same step from frame to frame and does not turn.
struct MovingFaces {
    const FaceTree& tree;
    FaceNumbers numbers;  ///< of its faces among those of all bodies
    Pose first;           ///< in its first frame
    Vec3 step_m{0};       ///< from frame to frame
    FrameSpan frames;     ///< as the buffer counts them
};

/// Puts every face of the body that a ray meets into the buffer, for all its frames at once; or the frames
/// alone in which it meets any. Exact up to rounding; two faces that share an edge leave no gap between them.
/// Thread-safety: pure but for the buffer.
void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, TimeBuffer& buffer);
void trace_moving_faces(const MovingFaces& faces, const RayPacket& rays, HiddenFrames& hidden);

}  // namespace afterglow
