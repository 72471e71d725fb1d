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
               std::uint64_t seed, const MovingLinesConfig& moving = {4, 16});

    /// L; 0 where the scene has no lamps.
    [[nodiscard]] Index lines_per_patch() const { return lines_per_patch_; }
    [[nodiscard]] std::size_t line(const PatchBlock& block, Index k, Index lane) const {
        return static_cast<std::size_t>(block.first) * lines_per_patch_ +
               static_cast<std::size_t>(k) * block.count + lane;
    }

    /// The first of the lines of a block that are one and the same as line k: k itself for static patches.
    [[nodiscard]] Index first_same(const PatchBlock& block, Index k) const {
        return block.body == furniture ? k : k - k % repeats_;
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
    Index repeats_ = 1;  ///< of every line of a moving patch; they stand together
    std::uint64_t seed_;
    SobolPoints points_;
};

/// Traces light lines and writes the contribution of each that is not blocked, 0 for the others.
/// Scope::static_geometry: those of static receivers only, without actors; Scope::everything: all. Returns
/// the number of rays. Errors: cancelled.
std::uint64_t trace_light_lines(const LightLines& light_lines, const SightLines& lines,
                                const RayCaster& caster, Scope scope, std::vector<float>& unblocked,
                                const Context& context);

}  // namespace afterglow
