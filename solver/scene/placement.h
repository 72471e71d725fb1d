#pragma once

#include <vector>

#include "solver/scene/moments.h"
#include "solver/scene/scene.h"
#include "solver/scene/world.h"

// Where nodes are over time: the transforms of a hierarchy composed into paths.

namespace afterglow {

using Mat3 = glm::mat3;

/// A node's local transform and how it changes.
struct NodeMotion {
    Transform local;                     ///< with constant tracks applied
    std::vector<Key<Vec3>> translation;  ///< empty: constant
    std::vector<Key<Quat>> rotation;     ///< empty: constant

    [[nodiscard]] bool moves() const { return !translation.empty() || !rotation.empty(); }
    [[nodiscard]] Transform at(double time_s, JumpSide side) const;
};

/// The motion of every node, in their order. Tracks that never leave their first value by more than the
/// tolerances count as constant.
std::vector<NodeMotion> motions_of(const Scene& scene, double tolerance_m, double tolerance_rad);

/// The node and its ancestors, the root first.
std::vector<Index> chain_to(const Scene& scene, Index node);

/// The product of the transforms along a chain.
struct Placement {
    Mat3 linear{1};             ///< rotations and scales
    Quat rotation{1, 0, 0, 0};  ///< the rotations alone
    Vec3 origin{0};

    /// This placement with a transform applied below it.
    [[nodiscard]] Placement then(const Transform& local) const;
    [[nodiscard]] Vec3 point(const Vec3& p) const { return linear * p + origin; }
};

/// Composes the motions along chains of nodes into rigid paths. Thread-safety: one thread at a time.
class PathMaker {
  public:
    PathMaker(const Scene& scene, const std::vector<NodeMotion>& motions, double tolerance_m,
              double tolerance_rad)
        : scene_(scene), motions_(motions), tolerance_m_(tolerance_m), tolerance_rad_(tolerance_rad) {}

    /// The path of an actor, and the linear map from its node's coordinates into the actor's own frame, which
    /// holds all scale. Errors: unsupported where the node's shape changes as it turns; too_large where the
    /// paths of the scene need too many keys.
    struct ActorFrame {
        Mat3 baked{1};
        Path path;
    };
    ActorFrame actor_frame(Index node);

    /// The path of a camera or a light: scale and mirroring turn its axes but do not deform it. At least one
    /// key. Errors: too_large as above.
    Path view_path(Index node);

  private:
    enum class Scales { even, uneven };
    [[nodiscard]] Placement at(const std::vector<Index>& chain, const Moment& moment) const;
    [[nodiscard]] Scales scales_above(const std::vector<Index>& chain) const;
    [[nodiscard]] std::vector<Moment> moments(const std::vector<Index>& chain, Scales scales);

    const Scene& scene_;
    const std::vector<NodeMotion>& motions_;
    double tolerance_m_;
    double tolerance_rad_;
    double composed_ = 0;  ///< transforms so far, against a limit
};

}  // namespace afterglow
