#pragma once

#include <span>
#include <vector>

#include "solver/visibility/lines_alone.h"
#include "solver/visibility/static_pass.h"
#include "solver/visibility/swept_actors.h"

namespace afterglow {

/// A line that sees something else from one frame on than in the frame before.
struct LineEvent {
    Index line = 0;
    Index from = 0, to = 0;  ///< what it saw and sees: as LineTargets, or `lamp_open` and `lamp_hidden`
    bool operator==(const LineEvent&) const = default;
};
inline constexpr Index lamp_open = 0;    ///< nothing moving stands between a light line's ends
inline constexpr Index lamp_hidden = 1;  ///< an actor does

/// All that happens to a set of lines over some frames, frame by frame and by line within a frame. The first
/// frame's events lead there from what the lines see without actors.
struct LineEvents {
    std::vector<std::size_t> first_of_frame;  ///< size frames + 1
    std::vector<LineEvent> list;

    [[nodiscard]] std::span<const LineEvent> at(int frame) const {
        const auto f = static_cast<std::size_t>(frame);
        return {list.data() + first_of_frame[f], first_of_frame[f + 1] - first_of_frame[f]};
    }
};

/// What events are found for: lines of static patches, and the actors as they move.
struct EventScene {
    const World& world;
    const PatchMesh& mesh;
    const SightLines& sight;
    const LightLines& light;
    const StaticLines& background;
    const SweptActors& actors;
    const RayCaster& placed;  ///< furniture only is asked for
};

/// Some packets of the static patches' lines, [block · packets a block + direction or sample] = 1; empty:
/// all.
using PacketMask = std::vector<std::uint8_t>;

/// The events of the static patches' sight lines in a range of directions, whose background must be known; of
/// the packets in `wanted`, by lines_per_patch directions a block. The same for any number of threads.
/// Errors: too_large where there are more than 2³² lines; cancelled.
LineEvents find_line_events(const EventScene& scene, const DirectionRange& range, const PacketMask& wanted,
                            const Context& context);

/// Whether the lines of actors' patches can be looked ahead along: no actor turns, and the furniture, whose
/// tree must be among the actors', is so simple that it costs less than tracing them in every frame.
bool can_look_ahead_along_own_lines(const SweptActors& actors, const FaceTree& furniture_tree);

/// The events of actors' patches' sight lines in a range of directions, of lines that are one and the same
/// once. The first frame's lead there from what they see of their own body, `alone`, which must be known that
/// far. Errors: likewise.
LineEvents find_own_line_events(const EventScene& scene, const LinesAlone& alone, const DirectionRange& range,
                                const Context& context);

/// The events of the static patches' light lines that end on static lamps: hidden or not. Errors: likewise.
LineEvents find_light_events(const EventScene& scene, const PacketMask& wanted, const Context& context);

}  // namespace afterglow
