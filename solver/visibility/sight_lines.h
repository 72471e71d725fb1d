#pragma once

#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/sampling.h"
#include "solver/mesh/lift.h"
#include "solver/mesh/patch_mesh.h"
#include "solver/visibility/ray_caster.h"

namespace afterglow {

/// What a sight line sees where it sees no patch.
inline constexpr Index sees_nothing = no_index;  ///< it leaves the scene
inline constexpr Index sees_inside =
    no_index - 1;  ///< its origin is buried: it meets a side that light cannot reach

/// Sixteen or fewer neighbouring patches whose sight lines share their directions.
struct PatchBlock {
    Index first = 0;
    Index count = 0;
    Index body = 0;
};

/// How many of an actor's lines are lines of their own. Static patches are traced once, actors' at every
/// frame.
struct MovingLinesConfig {
    Index repeats = 4;  ///< at most so many lines of a moving patch are one and the same, 1 or more
    Index fewest = 64;  ///< no fewer lines of their own than this are left to a patch by repeating
};

/// How many of a moving patch's lines differ: as few as allowed such that every one of them is repeated
/// equally often.
Index different_moving_lines(Index lines_per_patch, const MovingLinesConfig& moving);

/// The sight lines of all patches. Rays are never stored: line d of a patch follows from the patch's block, d
/// and the seed. Line (block, d, lane) has the index block.first · D + d · block.count + lane, so that the
/// lines traced together stand together. Thread-safety: const after construction.
class SightLines {
  public:
    /// `lines_per_patch` D ≥ 1. The mesh and world are read at construction and by `rays`; the mesh must
    /// outlive this.
    SightLines(const PatchMesh& mesh, const World& world, Index lines_per_patch, std::uint64_t seed,
               const MovingLinesConfig& moving = {});

    [[nodiscard]] Index lines_per_patch() const { return lines_per_patch_; }
    [[nodiscard]] const std::vector<PatchBlock>& blocks() const { return blocks_; }
    /// Blocks of the furniture come first: their number.
    [[nodiscard]] std::size_t static_blocks() const { return static_blocks_; }
    /// The block that a patch belongs to.
    [[nodiscard]] std::size_t block_of(Index patch) const;
    [[nodiscard]] std::size_t line(const PatchBlock& block, Index direction, Index lane) const {
        return static_cast<std::size_t>(block.first) * lines_per_patch_ +
               static_cast<std::size_t>(direction) * block.count + lane;
    }
    /// How many lines of a block's patches differ: D of static ones. Of moving ones it may be a fraction of
    /// it, the first of the same well-spread sequence; line d is then line d modulo this.
    [[nodiscard]] Index different_lines(const PatchBlock& block) const {
        return block.body == furniture ? lines_per_patch_ : moving_lines_;
    }
    /// How far an origin is lifted off its surface so that a ray does not meet the surface it starts on.
    [[nodiscard]] float lift_m() const { return lift_m_; }

    /// What direction and place on their patches the lines of one direction of a block have in common.
    [[nodiscard]] Sample4 sample(std::size_t block, Index direction) const;
    [[nodiscard]] const PatchMesh& mesh() const { return *mesh_; }
    /// The rays of one direction of a block, in world coordinates with the block's body at `pose`; far is
    /// infinite.
    void rays(std::size_t block, Index direction, const Pose& pose, RayPacket& out) const;

  private:
    const PatchMesh* mesh_;
    Index lines_per_patch_, moving_lines_;
    std::uint64_t seed_;
    SobolPoints points_;
    std::vector<PatchBlock> blocks_;
    std::size_t static_blocks_ = 0;
    float lift_m_ = 0;
};

/// What lines see, by line index.
struct LineTargets {
    std::vector<Index> patch;     ///< or sees_nothing, sees_inside
    std::vector<float> distance;  ///< metres; infinite where nothing is met
};

/// Where traced lines are written, by line index; distances only where there is room for them.
struct LineSinks {
    std::span<Index> patch;
    std::span<float> distance;
};

/// The patch, or sees_inside / sees_nothing, that a hit stands for; the ray is in the frame of the body hit.
Index target_of(const Hit& hit, const Ray& ray, const PatchMesh& mesh);
/// The same for a ray in world coordinates.
Index target_of(const Hit& hit, const Ray& ray, const PatchMesh& mesh, const RayCaster& caster);

/// Part of all lines: blocks [first_block, last_block) and directions [first_direction, last_direction).
struct LineRange {
    std::size_t first_block = 0, last_block = 0;
    Index first_direction = 0, last_direction = 0;
};

/// Traces lines against the furniture and, with Scope::everything, the actors, and writes what they see.
/// Lines that are one and the same are traced once where all are in the range. Returns the number of rays.
/// Errors: cancelled.
std::uint64_t trace_lines(const SightLines& lines, const PatchMesh& mesh, const RayCaster& caster,
                          Scope scope, const LineRange& range, const LineSinks& sinks,
                          const Context& context);

/// Directions [first, last) of every patch.
struct DirectionRange {
    Index first = 0, last = 0;
};

}  // namespace afterglow
