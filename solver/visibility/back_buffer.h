#pragma once

#include <optional>

#include "solver/visibility/encounters.h"
#include "solver/visibility/own_light_lines.h"
#include "solver/visibility/own_lines.h"

namespace afterglow {

/// Static lines keep their backgrounds. Packets of them that meet no actor's swept volume before that are
/// never looked at again; of the others only those lines are traced that meet an actor's box where it stands
/// now. Where nothing has moved nothing is traced. Source: Baum et al. 1986.
class BackBuffer final : public VisibilityStrategy {
  public:
    /// Keeps copies of what it needs of the world. `clock` tells what LineScene::frame means.
    BackBuffer(const World& world, const FrameClock& clock);

    [[nodiscard]] bool needs_background() const override { return true; }
    std::uint64_t update(const LineScene& scene, const DirectionRange& range, VisibleLines& visible,
                         const Context& context) override;
    /// None where no static line has been looked along since the last call; else it does not know.
    [[nodiscard]] std::optional<LineChanges> take_changes() override;

  private:
    void find_encounters(const LineScene& scene, const DirectionRange& range, const Context& context);
    std::uint64_t look(const LineScene& scene, std::size_t block, const DirectionRange& range,
                       VisibleLines& visible) const;
    std::uint64_t look_at_lamps(const LineScene& scene, std::size_t block, VisibleLines& visible) const;

    FrameClock clock_;
    PlacedActors actors_;
    TimeTree times_;
    std::vector<SpacetimeExtent> extents_;     ///< by actor: body k + 1 is actor k
    std::vector<BlockEncounters> encounters_;  ///< by static block
    Index directions_ = 0;                     ///< whose encounters are known
    bool lamps_known_ = false;
    Index shown_ = 0;     ///< directions that `visible` shows as they are now; the light lines, too, unless 0
    bool looked_ = true;  ///< along static lines, since changes were last asked for
    OwnLines own_;
    OwnLightLines own_light_;
};

}  // namespace afterglow
