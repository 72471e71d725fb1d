#pragma once

#include <vector>

#include "solver/visibility/light_lines.h"
#include "solver/visibility/line_tests.h"
#include "solver/visibility/spacetime_extent.h"
#include "solver/visibility/static_pass.h"

namespace afterglow {

/// An actor that may come between some of a packet's lines and their backgrounds, and when. The lines of a
/// packet without any are definitely valid: nothing ever hides what they see.
struct Encounter {
    Index direction = 0;  ///< of the packet: sight line's direction, or light line's number
    Index actor = 0;      ///< from 0: body − 1
    std::uint16_t first_slice = 0, last_slice = 0;  ///< of the time tree, both included

    [[nodiscard]] bool during(std::size_t slice) const { return first_slice <= slice && slice <= last_slice; }
};

/// The encounters of one block's packets, in order of directions.
struct BlockEncounters {
    std::vector<Encounter> sight, light;
};

/// Appends those of sight lines [range.first, range.last) of a static block; their backgrounds must be known.
void find_encounters(const SightLines& sight, std::size_t block, const LineTargets& background,
                     const DirectionRange& range, std::span<const SpacetimeExtent> actors,
                     const TimeTree& times, std::vector<Encounter>& out);

/// Those of a static block's lines to static lamps. `placed` may have any poses.
void find_light_encounters(const LightLines& light, const SightLines& sight, const PatchMesh& mesh,
                           std::size_t block, const RayCaster& placed, const std::vector<float>& unblocked,
                           std::span<const SpacetimeExtent> actors, const TimeTree& times,
                           std::vector<Encounter>& out);

}  // namespace afterglow
