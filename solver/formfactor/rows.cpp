#include "solver/formfactor/rows.h"

#include <algorithm>
#include <numeric>

#include "solver/formfactor/row_counter.h"

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 256;

/// A centre in one body's frame, seen from another's.
Vec3 moved(const RayCaster& placed, Index from, Index to, const Vec3& point) {
    if (from == to) return point;
    const Pose& target = placed.pose(to);
    return glm::conjugate(target.rotation) * (placed.pose(from).point(point) - target.translation);
}

/// Some consecutive rows, before they are joined.
struct Part {
    std::vector<Index> row_size;
    std::vector<Index> column;
    std::vector<float> value;

    void add(Index patch, float factor) {
        column.push_back(patch);
        value.push_back(factor);
    }
};

class RowCompiler {
  public:
    RowCompiler(const PatchMesh& mesh, const SightLines& lines, const LightLines& light_lines,
                const Lamps& lamps, const RayCaster& placed, const SeenLines& seen, FormFactors& out)
        : mesh_(mesh),
          lines_(lines),
          light_lines_(light_lines),
          lamps_(lamps),
          placed_(placed),
          seen_(seen),
          out_(out) {}

    /// Which lamp patches a block's light lines end on, by line.
    void lamp_patches(std::size_t block, std::vector<Index>& patches) const {
        patches.resize(light_lines_.lines_per_patch());
        for (Index k = 0; k < patches.size(); ++k) patches[k] = light_lines_.lamp_patch(block, k);
    }

    /// The row of a patch of a block, the `place`-th asked for.
    void compile(const PatchBlock& block, Index patch, std::size_t place, std::span<const Index> lamp_patches,
                 RowCounter& row, Part& part) const {
        const std::size_t first = part.column.size();
        compile_row(block, patch, place, lamp_patches, row, part);
        part.row_size.push_back(static_cast<Index>(part.column.size() - first));
    }

  private:
    /// Counts lines by target into the row, all but those that light lines count.
    template <class ByLightLines>
    LineTally count_lines(const PatchBlock& block, Index lane, const ByLightLines& by_light_lines,
                          RowCounter& row) const {
        LineTally tally;
        // Lines that are one and the same are looked at once.
        const Index different = std::min(lines_.different_lines(block), seen_.directions);
        const Index each = seen_.directions / different, once_more = seen_.directions % different;
        for (Index d = 0; d < different; ++d) {
            const Index target = seen_.visible[lines_.line(block, d, lane)];
            const Index lines = each + (d < once_more ? 1 : 0);
            if (target == sees_nothing) {
                tally.outside += lines;
            } else if (target == sees_inside) {
                tally.buried += lines;
            } else if (by_light_lines(target)) {
                tally.on_lamps += lines;
            } else {
                tally.on_others += lines;
                row.add(target, static_cast<float>(lines));
            }
        }
        return tally;
    }

    void compile_row(const PatchBlock& block, Index patch, std::size_t place,
                     std::span<const Index> lamp_patches, RowCounter& row, Part& part) const {
        const Index lane = patch - block.first;
        const std::vector<char> near = lamps_near(mesh_, lamps_, placed_, patch);
        const auto by_light_lines = [&](Index target) {
            const Index lamp = lamps_.lamp_of_patch[target];
            return lamp != no_index && near[lamp] == 0;
        };
        LineTally tally = count_lines(block, lane, by_light_lines, row);
        out_.valid_share[place] = static_cast<float>(tally.valid()) / static_cast<float>(seen_.directions);
        if (tally.valid() == 0) return;

        // Buried origins gave zeros; the others stand for the whole patch.
        const float scale = 1 / out_.valid_share[place];
        float from_lamps = 0;
        for (Index k = 0; k < lamp_patches.size(); ++k)
            if (by_light_lines(lamp_patches[k]))
                from_lamps += scale * seen_.light_contribution[light_lines_.line(block, k, lane)];
        Index others = tally.outside + tally.on_others;
        float weight = (1 - from_lamps) / static_cast<float>(others);
        if (from_lamps >= 1 || others == 0) {
            // Lamps fill the view: sight lines count them better than light lines can.
            row.end_row([](Index, float) {});
            tally = count_lines(
                block, lane, [](Index) { return false; }, row);
            weight = 1 / static_cast<float>(tally.valid());
            lamp_patches = {};
        }
        row.end_row([&](Index column, float lines) { part.add(column, weight * lines); });
        out_.sky[place] = weight * static_cast<float>(tally.outside);
        for (Index k = 0; k < lamp_patches.size(); ++k) {
            const float contribution = scale * seen_.light_contribution[light_lines_.line(block, k, lane)];
            if (contribution > 0 && by_light_lines(lamp_patches[k])) row.add(lamp_patches[k], contribution);
        }
        row.end_row([&](Index column, float factor) { part.add(column, factor); });
    }

    const PatchMesh& mesh_;
    const SightLines& lines_;
    const LightLines& light_lines_;
    const Lamps& lamps_;
    const RayCaster& placed_;
    const SeenLines& seen_;
    FormFactors& out_;
};

/// Joins the parts, in order, into one matrix.
FormFactorMatrix join(const std::vector<Part>& parts, std::size_t rows, const Context& context) {
    FormFactorMatrix matrix;
    matrix.row_begin.reserve(rows + 1);
    std::vector<std::size_t> first_entry{0};
    for (const Part& part : parts) {
        for (const Index size : part.row_size) matrix.row_begin.push_back(matrix.row_begin.back() + size);
        first_entry.push_back(matrix.row_begin.back());
    }
    matrix.column.resize(first_entry.back());
    matrix.value.resize(first_entry.back());
    context.for_chunks(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            std::copy(parts[p].column.begin(), parts[p].column.end(),
                      matrix.column.begin() + static_cast<std::ptrdiff_t>(first_entry[p]));
            std::copy(parts[p].value.begin(), parts[p].value.end(),
                      matrix.value.begin() + static_cast<std::ptrdiff_t>(first_entry[p]));
        }
    });
    return matrix;
}

}  // namespace

std::vector<char> lamps_near(const PatchMesh& mesh, const Lamps& lamps, const RayCaster& placed,
                             Index patch) {
    std::vector<char> near(lamps.list.size(), 0);
    for (std::size_t l = 0; l < near.size(); ++l) {
        const Lamp& lamp = lamps.list[l];
        near[l] = static_cast<char>(
            is_near(lamp, moved(placed, mesh.body[patch], lamp.body, mesh.centre[patch]), {}));
    }
    return near;
}

FormFactors compile_rows_of(std::span<const Index> patches, const PatchMesh& mesh, const SightLines& lines,
                            const LightLines& light_lines, const Lamps& lamps, const RayCaster& placed,
                            const SeenLines& seen, const Context& context) {
    FormFactors out;
    out.sky.assign(patches.size(), 0);
    out.valid_share.assign(patches.size(), 0);
    const RowCompiler compiler(mesh, lines, light_lines, lamps, placed, seen, out);
    std::vector<Part> parts((patches.size() + rows_per_chunk - 1) / rows_per_chunk);
    context.for_chunks(patches.size(), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
        RowCounter row(mesh.size());
        std::vector<Index> lamp_patches;
        std::size_t block = lines.blocks().size();
        for (std::size_t k = begin; k < end; ++k) {
            // Neighbours mostly follow each other.
            if (const std::size_t its = lines.block_of(patches[k]); its != block) {
                block = its;
                compiler.lamp_patches(block, lamp_patches);
            }
            compiler.compile(lines.blocks()[block], patches[k], k, lamp_patches, row,
                             parts[begin / rows_per_chunk]);
        }
    });
    out.matrix = join(parts, patches.size(), context);
    return out;
}

FormFactors compile_rows(const PatchMesh& mesh, const SightLines& lines, const LightLines& light_lines,
                         const Lamps& lamps, const RayCaster& placed, const SeenLines& seen,
                         const Context& context) {
    std::vector<Index> all(mesh.size());
    std::iota(all.begin(), all.end(), Index{0});
    return compile_rows_of(all, mesh, lines, light_lines, lamps, placed, seen, context);
}

}  // namespace afterglow
