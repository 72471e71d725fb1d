#pragma once

#include <vector>

#include "solver/visibility/ray_caster.h"
#include "solver/visibility/sight_lines.h"

namespace afterglow {

/// What the lines of actors' patches meet of their own body, which they do at every time: traced once, in the
/// body's frame. Lines that are one and the same are kept once. Thread-safety: different blocks at a time.
class LinesAlone {
  public:
    /// Traces directions of a block of an actor's patches up to `last` that are not known yet. Always asked
    /// for the same lines. Returns the number of rays.
    std::uint64_t extend(const SightLines& sight, const PatchMesh& mesh, const RayCaster& caster,
                         std::size_t block, Index last);
    /// Makes room for all lines; to be called before the first `extend`, by one thread.
    void reserve(const SightLines& sight, const PatchMesh& mesh);

    /// How many lines are kept.
    [[nodiscard]] std::size_t size() const { return lines_.patch.size(); }
    /// Where a block's lines of one of its different directions stand.
    [[nodiscard]] static std::size_t index(const SightLines& sight, const PatchMesh& mesh,
                                           const PatchBlock& block, Index direction) {
        return std::size_t{block.first - mesh.static_size()} * sight.different_lines(block) +
               std::size_t{direction} * block.count;
    }
    /// What they meet; distances are short of it by a lift, so that what touches the body there is not seen.
    [[nodiscard]] const LineTargets& lines() const { return lines_; }

  private:
    std::vector<Index> known_;  ///< directions, by block, the first actor's first
    LineTargets lines_;
};

}  // namespace afterglow
