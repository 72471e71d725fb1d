#pragma once

#include <algorithm>
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

/// What encounters are found for and with.
struct EncounterScene {
    const PatchMesh& mesh;
    const SightLines& sight;
    const LightLines& light;
    const RayCaster& placed;  ///< may have any poses
    const StaticLines& background;
    std::span<const SpacetimeExtent> actors;
    const TimeTree& times;
};

/// Encounters of all static blocks, `encounters` being empty or what earlier calls left: sight lines of
/// directions `range`, whatever was known of them and later ones being forgotten. Errors: cancelled, after
/// which the same call makes up for it.
void extend_encounters(const EncounterScene& scene, const DirectionRange& range,
                       std::vector<BlockEncounters>& encounters, const Context& context);
/// The same for all light lines to static lamps.
void find_light_encounters(const EncounterScene& scene, std::vector<BlockEncounters>& encounters,
                           const Context& context);

/// Calls `body(direction, due encounters)` for every packet in the range of which some encounter is due.
template <class Body>
void for_due_packets(std::span<const Encounter> encounters, const DirectionRange& range, std::size_t slice,
                     const Body& body) {
    std::vector<Encounter> due;
    auto at = std::partition_point(encounters.begin(), encounters.end(),
                                   [&](const Encounter& e) { return e.direction < range.first; });
    while (at != encounters.end() && at->direction < range.last) {
        const Index direction = at->direction;
        due.clear();
        for (; at != encounters.end() && at->direction == direction; ++at)
            if (at->during(slice)) due.push_back(*at);
        if (!due.empty()) body(direction, std::span<const Encounter>(due));
    }
}

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
