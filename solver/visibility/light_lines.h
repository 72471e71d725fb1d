#pragma once

#include <vector>

#include "solver/visibility/lamps.h"
#include "solver/visibility/sight_lines.h"

namespace afterglow {

/// The light lines of all patches: from points of a patch to points of the lamps, stratified over both. Like
/// sight lines they are regenerated, not stored; line (block, k, lane) has the index block.first · L + k ·
/// block.count + lane. Thread-safety: const after construction.
class LightLines {
  public:
    LightLines(const PatchMesh& mesh, const SightLines& lines, const Lamps& lamps, Index lines_per_patch,
               std::uint64_t seed);

    /// L; 0 where the scene has no lamps.
    [[nodiscard]] Index lines_per_patch() const { return lines_per_patch_; }
    [[nodiscard]] std::size_t line(const PatchBlock& block, Index k, Index lane) const {
        return static_cast<std::size_t>(block.first) * lines_per_patch_ +
               static_cast<std::size_t>(k) * block.count + lane;
    }

    /// The lamp patch that line k of a block samples.
    [[nodiscard]] Index lamp_patch(std::size_t block, Index k) const;

    /// The rays of one sample of a block, and each lane's form-factor contribution if nothing stands between:
    /// cos θ cos θ' A' / (π r² L q), with q the probability of the lamp patch; 0 where the two do not face
    /// each other.
    void rays(std::size_t block, Index k, const RayCaster& placed, RayPacket& out,
              std::array<float, 16>& contribution) const;

  private:
    struct Choice {
        Index patch;
        float probability;
    };
    [[nodiscard]] Choice choose(std::size_t block, Index k) const;

    const PatchMesh* mesh_;
    const SightLines* lines_;
    const Lamps* lamps_;
    Index lines_per_patch_;
    std::uint64_t seed_;
    SobolPoints points_;
};

/// Traces light lines and writes the contribution of each that is not blocked, 0 for the others.
/// Scope::static_geometry: those of static receivers only, without actors. Scope::everything: all, traced
/// anew. Scope::actors: `unblocked` holds the contributions without actors of static receivers; only their
/// lines to static lamps that are not yet 0 are traced, against the actors alone, and everything else anew.
/// Returns the number of rays. Errors: cancelled.
std::uint64_t trace_light_lines(const LightLines& light_lines, const SightLines& lines, const PatchMesh& mesh,
                                const RayCaster& caster, Scope scope, std::vector<float>& unblocked,
                                const Context& context);

/// Traces anew, against everything, the light lines that move from frame to frame: those of actors' patches,
/// and those that end on an actor's lamp. Returns the number of rays. Errors: cancelled.
std::uint64_t trace_moving_light_lines(const LightLines& light_lines, const SightLines& lines,
                                       const PatchMesh& mesh, const RayCaster& caster,
                                       std::vector<float>& unblocked, const Context& context);

}  // namespace afterglow
