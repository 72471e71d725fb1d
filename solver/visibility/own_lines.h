#pragma once

#include "solver/visibility/lines_alone.h"
#include "solver/visibility/placed_actors.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// The sight lines of actors' patches, exact at every frame and without memory of how it was reached. What a
/// rigid body sees of itself it sees for ever: that is traced once, in its own frame, and is as far as a line
/// has to go. Then the furniture, in packets, where the body has moved; then the other actors, where a line
/// meets their boxes and one of the two has moved. What stands as it stood is not traced. One thread at a
/// time.
class OwnLines {
  public:
    /// Keeps no reference to the world.
    explicit OwnLines(const World& world) : actors_(world) {}

    /// Brings directions [range.first, range.last) up to date in `visible`. Returns the number of rays.
    /// Always asked for the same lines. Errors: cancelled, after which the next call goes on.
    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context);

  private:
    /// How many directions of a block are known: with the furniture, with all.
    struct Known {
        Index background = 0, all = 0;
    };
    void forget_what_moved(const LineScene& scene);
    std::uint64_t learn(const LineScene& scene, std::size_t block, Index last);
    [[nodiscard]] std::uint64_t look_at_furniture(const LineScene& scene, const LinePacket& lines,
                                                  std::size_t at);
    void show(const LineScene& scene, std::size_t block, const DirectionRange& range,
              VisibleLines& visible) const;
    [[nodiscard]] static std::size_t index(const LineScene& scene, const PatchBlock& block, Index d) {
        return LinesAlone::index(scene.sight, scene.mesh, block, d);
    }

    PlacedActors actors_;
    std::vector<Known> known_;  ///< by block, the first actor's first
    LinesAlone alone_;
    LineTargets background_;  ///< of its own body and the furniture
    std::vector<Index> all_;
};

}  // namespace afterglow
