#include "solver/formfactor/rows.h"

#include <algorithm>
#include <numeric>

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
};

/// Collects one row, merging equal columns by a table of where each was last put.
class RowBuilder {
  public:
    explicit RowBuilder(std::size_t columns) : place_(columns, 0) {}

    void begin(Part& part) {
        part_ = &part;
        first_ = part.column.size();
    }
    void add(Index column, float value) {
        std::size_t& place = place_[column];
        // Stale places lie before this row or hold another column.
        if (place >= first_ && place < part_->column.size() && part_->column[place] == column) {
            part_->value[place] += value;
            return;
        }
        place = part_->column.size();
        part_->column.push_back(column);
        part_->value.push_back(value);
    }
    void end() { part_->row_size.push_back(static_cast<Index>(part_->column.size() - first_)); }

  private:
    std::vector<std::size_t> place_;
    Part* part_ = nullptr;
    std::size_t first_ = 0;
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

    /// The row of a patch, the `place`-th asked for.
    void compile(Index patch, std::size_t place, RowBuilder& row, Part& part) const {
        row.begin(part);
        const std::size_t block = lines_.block_of(patch);
        compile_row(block, patch, place, row);
        row.end();
    }

  private:
    /// What a patch's sight lines meet.
    struct Count {
        Index outside = 0, buried = 0, on_lamps = 0, on_others = 0;
        [[nodiscard]] Index valid() const { return outside + on_lamps + on_others; }
    };

    template <class ByLightLines>
    Count count_lines(const PatchBlock& block, Index lane, const ByLightLines& by_light_lines) const {
        Count count;
        for (Index d = 0; d < seen_.directions; ++d) {
            const Index target = seen_.visible[lines_.line(block, d, lane)];
            if (target == sees_nothing)
                ++count.outside;
            else if (target == sees_inside)
                ++count.buried;
            else if (by_light_lines(target))
                ++count.on_lamps;
            else
                ++count.on_others;
        }
        return count;
    }

    void compile_row(std::size_t block_index, Index patch, std::size_t place, RowBuilder& row) const {
        const PatchBlock& block = lines_.blocks()[block_index];
        const Index lane = patch - block.first;
        const std::vector<char> near = lamps_near(mesh_, lamps_, placed_, patch);
        const auto by_light_lines = [&](Index target) {
            const Index lamp = lamps_.lamp_of_patch[target];
            return lamp != no_index && near[lamp] == 0;
        };
        const Count count = count_lines(block, lane, by_light_lines);
        out_.valid_share[place] = static_cast<float>(count.valid()) / static_cast<float>(seen_.directions);
        if (count.valid() == 0) return;

        // Buried origins gave zeros; the others stand for the whole patch.
        const float scale = 1 / out_.valid_share[place];
        float from_lamps = 0;
        for (Index k = 0; k < light_lines_.lines_per_patch(); ++k)
            if (by_light_lines(light_lines_.lamp_patch(block_index, k)))
                from_lamps += scale * seen_.light_contribution[light_lines_.line(block, k, lane)];
        const Index others = count.outside + count.on_others;
        if (from_lamps >= 1 || others == 0) {
            // Lamps fill the view: sight lines count them better than light lines can.
            add_sight_lines(block, lane, 1 / static_cast<float>(count.valid()), row,
                            [](Index) { return true; });
            out_.sky[place] = static_cast<float>(count.outside) / static_cast<float>(count.valid());
            return;
        }
        for (Index k = 0; k < light_lines_.lines_per_patch(); ++k) {
            const Index target = light_lines_.lamp_patch(block_index, k);
            const float contribution = scale * seen_.light_contribution[light_lines_.line(block, k, lane)];
            if (contribution > 0 && by_light_lines(target)) row.add(target, contribution);
        }
        const float weight = (1 - from_lamps) / static_cast<float>(others);
        add_sight_lines(block, lane, weight, row, [&](Index target) { return !by_light_lines(target); });
        out_.sky[place] = weight * static_cast<float>(count.outside);
    }

    template <class Counts>
    void add_sight_lines(const PatchBlock& block, Index lane, float weight, RowBuilder& row,
                         const Counts& counts) const {
        for (Index d = 0; d < seen_.directions; ++d) {
            const Index target = seen_.visible[lines_.line(block, d, lane)];
            if (target != sees_nothing && target != sees_inside && counts(target)) row.add(target, weight);
        }
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
        RowBuilder row(mesh.size());
        for (std::size_t k = begin; k < end; ++k)
            compiler.compile(patches[k], k, row, parts[begin / rows_per_chunk]);
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
