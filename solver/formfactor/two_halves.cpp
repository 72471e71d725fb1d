#include "solver/formfactor/two_halves.h"

#include <algorithm>
#include <array>

namespace afterglow {

namespace {

constexpr std::size_t blocks_per_chunk = 16;

/// The share of what a patch receives that does not come from lamps.
float share_of_others(const FormFactors& factors, const Lamps& lamps, Index patch) {
    float share = factors.sky[patch];
    const FormFactorMatrix& matrix = factors.matrix;
    for (std::uint64_t k = matrix.row_begin[patch]; k < matrix.row_begin[patch + 1]; ++k)
        if (lamps.lamp_of_patch[matrix.column[k]] == no_index) share += matrix.value[k];
    return share;
}

}  // namespace

std::vector<Rgb> half_differences(const SightLines& lines, const Lamps& lamps, const SeenLines& seen,
                                  const FormFactors& factors, std::span<const Rgb> radiosity,
                                  const Rgb& outside, const Context& context) {
    struct Half {
        Rgb sum{0};
        float count = 0;
    };
    const auto of_lane = [&](const PatchBlock& block, Index lane) {
        std::array<Half, 2> halves;
        // Lines that are one and the same say nothing of each other's noise.
        const Index directions = std::min(seen.directions, lines.different_lines(block));
        for (Index d = 0; d < directions; ++d) {
            const Index target = seen.visible[lines.line(block, d, lane)];
            const bool leaves = target == sees_nothing;
            if (target == sees_inside || (!leaves && lamps.lamp_of_patch[target] != no_index)) continue;
            Half& half = halves[2 * d < directions ? 0 : 1];
            half.sum += leaves ? outside : radiosity[target];
            half.count += 1;
        }
        if (halves[0].count == 0 || halves[1].count == 0) return Rgb(0);
        return 0.5F * share_of_others(factors, lamps, block.first + lane) *
               (halves[0].sum / halves[0].count - halves[1].sum / halves[1].count);
    };
    std::vector<Rgb> differences(radiosity.size());
    context.for_chunks(lines.blocks().size(), blocks_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const PatchBlock& block = lines.blocks()[b];
            for (Index lane = 0; lane < block.count; ++lane)
                differences[block.first + lane] = of_lane(block, lane);
        }
    });
    return differences;
}

}  // namespace afterglow
