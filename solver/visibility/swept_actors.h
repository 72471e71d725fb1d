#pragma once

#include <span>
#include <vector>

#include "solver/visibility/face_tree.h"
#include "solver/visibility/hidden_frames.h"
#include "solver/visibility/motion.h"
#include "solver/visibility/time_buffer.h"

namespace afterglow {

/// A tree over the faces of every body; the furniture's is empty unless somebody needs it and puts it in.
using ActorTrees = std::vector<FaceTree>;
ActorTrees make_actor_trees(const World& world);

/// The actors as they move over some consecutive frames, ready to be met by rays that stand still. A ray and
/// a direction of motion span a plane; a face that moves without turning cuts it in a line segment, so that
/// which frames see the face, and how far off it is in each, comes from two edges: no frame is looked at
/// alone, and nothing between frames is missed that a frame shows. A turning actor is placed anew in each
/// frame in which a ball around it touches a ray. Thread-safety: const calls are pure.
class SweptActors {
  public:
    /// The world and its trees must outlive this.
    SweptActors(const World& world, const ActorTrees& trees, const FrameClock& clock,
                const FrameSpan& frames);

    [[nodiscard]] const FrameSpan& frames() const { return frames_; }

    /// Where an actor stands in a frame, counted from the first.
    [[nodiscard]] const Pose& pose(Index body, int frame) const {
        return poses_[body][static_cast<std::size_t>(frame)];
    }

    /// Whether an actor goes on from a frame to the next as it came there: at the same velocity, without
    /// turning.
    [[nodiscard]] bool is_steady_after(Index body, int frame) const {
        return steady_after_[body][static_cast<std::size_t>(frame)] != 0;
    }

    /// What an actor does over the frames, part by part; they are counted from the first.
    [[nodiscard]] std::span<const SteadyFrames> parts(Index body) const { return parts_[body]; }
    /// Whether any actor turns in any frame.
    [[nodiscard]] bool any_turns() const;

    /// A face, as time buffers number them.
    struct Face {
        Index body;
        const ConvexFace& shape;
    };
    [[nodiscard]] Face face(Index number) const {
        const Index body = body_of_face_[number];
        return {body, (*trees_)[body].faces[number - first_face_[body]]};
    }

    /// The boxes an actor comes into, one for each steady part of its way, a little larger than exact.
    [[nodiscard]] std::vector<Box> boxes_of(Index body) const;

    /// Puts every face that a ray meets before its `far` into the buffer, which has been cleared for these
    /// rays and has as many frames.
    void trace(const RayPacket& rays, TimeBuffer& buffer) const;

    /// The same for the lines of an actor that does not turn, directions of a block given in its own frame:
    /// the furniture, whose tree must be there, and the other actors move past it. None of them may turn.
    void trace_from(Index body, const RayPacket& rays, TimeBuffer& buffer) const;

    /// Puts the frames in which a ray is blocked before its `far`, likewise.
    void trace(const RayPacket& rays, HiddenFrames& hidden) const;

  private:
    struct Ball {
        Vec3 centre{0};
        float radius_m = 0;
    };
    /// One actor over frames in which its motion is steady.
    struct Sweep {
        Index body = 0;
        SteadyFrames part;
        Box box;                  ///< of where it comes
        std::vector<Ball> balls;  ///< turning ones: a heap over the frames, the last level one ball a frame
    };
    /// All sweeps of one actor.
    struct Swept {
        Box box;
        std::vector<Sweep> sweeps;
    };
    [[nodiscard]] Sweep sweep_of(const SteadyFrames& part, Index body) const;
    [[nodiscard]] FaceNumbers numbers(Index body) const;
    template <class Buffer>
    void trace_near(const RayPacket& rays, Buffer& buffer) const;
    template <class Buffer>
    void trace_turning(const Sweep& sweep, std::size_t ball, const RayPacket& rays, Buffer& buffer) const;

    const ActorTrees* trees_;
    FrameSpan frames_;
    std::vector<Index> first_face_;  ///< by body: the number of its first face
    std::vector<Index> body_of_face_;
    std::vector<std::vector<Pose>> poses_;          ///< [body][frame]; empty for the furniture
    std::vector<std::vector<SteadyFrames>> parts_;  ///< [body]; empty for the furniture
    std::vector<std::vector<char>> steady_after_;   ///< [body][frame]; empty for the furniture
    std::vector<Swept> swept_;                      ///< actors that have faces
    float reach_m_ = 0;                             ///< no actor comes further off the origin of the world
};

}  // namespace afterglow
