#pragma once

#include <vector>

#include "solver/visibility/line_tests.h"

namespace afterglow {

/// Where the actors stand now, whether they stood there before, and packets of lines against one of them at a
/// time: only lines that meet its box are traced, in its own frame, where no instance has to be passed.
/// Thread-safety: const calls are pure.
class PlacedActors {
  public:
    /// Keeps no reference to the world.
    explicit PlacedActors(const World& world);

    /// Takes the actors' places from the caster. All count as moved the first time.
    void place(const RayCaster& caster);

    [[nodiscard]] Index bodies() const { return static_cast<Index>(local_boxes_.size()); }
    /// Whether an actor stands elsewhere than at the call of `place` before; false for the furniture.
    [[nodiscard]] bool moved(Index body) const { return moved_[body] != 0; }
    [[nodiscard]] bool any_moved() const;

    /// Traces the lanes of `lines` that meet an actor's box before their `far`, and returns them. Lanes that
    /// meet the actor itself get what they see written to `target`, and as their `far` how near the next must
    /// come to be seen instead: actors are looked at in the order of their numbers, see tie.h.
    std::uint32_t look(LinePacket& lines, Index body, const PatchMesh& mesh, const RayCaster& caster,
                       Index* target) const;

    /// The lanes among `open` that meet an actor's box, and those of them that it hides.
    struct Hidden {
        std::uint32_t traced = 0, hidden = 0;
    };
    [[nodiscard]] Hidden hide(const LinePacket& lines, std::uint32_t open, Index body,
                              const RayCaster& caster) const;

  private:
    std::vector<Box> local_boxes_, boxes_;  ///< by body; the furniture's are empty
    std::vector<Pose> poses_;
    std::vector<char> moved_;
    float slack_m_;
};

}  // namespace afterglow
