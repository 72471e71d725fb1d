#pragma once

#include "solver/visibility/line_events.h"

namespace afterglow {

// What is left of lines' events when one actor goes another way: only lines that meet its old swept boxes or
// its new ones before they end can see anything else.

/// The packets in which a line meets one of some boxes before its background, and how many there are among
/// those of the range. Errors: cancelled.
struct MetPackets {
    PacketMask mask;
    std::size_t met = 0, all = 0;
};
MetPackets sight_packets_meeting(const EventScene& scene, const DirectionRange& range,
                                 std::span<const Box> boxes, const Context& context);
/// Likewise of light lines that nothing static blocks.
MetPackets light_packets_meeting(const EventScene& scene, std::span<const Box> boxes, const Context& context);

/// The old events of all packets but the masked ones, with new ones in their place. `lines` is how many lines
/// each patch has. Frames as before.
LineEvents replace_events(const SightLines& sight, Index lines, const LineEvents& old,
                          const PacketMask& replaced, const LineEvents& fresh);

}  // namespace afterglow
