#include "solver/radiosity/residual_sums.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 128;
// A row's sums are computed afresh after so many additions, or when these amount to a share of the sums: so
// rounding never accumulates.
constexpr std::size_t most_additions = 256;
constexpr float wear_each = 1.0F / most_additions;
constexpr float most_share = 0.25F;
constexpr std::size_t whole_rows_per_chunk = 64;

/// What rows of a layer gather, computed afresh.
void gather_layer(const LayeredRows& layer, std::size_t first, std::size_t last,
                  std::span<const Lanes> radiosity, std::vector<DoubleLanes>& sums) {
    for (std::size_t row = first; row < last; ++row) sums[row] = gather_row(layer.base, row, radiosity);
    for (std::size_t b = first / block_size; b < layer.covered.size() && b * block_size < last; ++b)
        for_covered(layer, b, [&](std::size_t row, Index base, Index now, float value) {
            if (first <= row && row < last)
                add_light(sums[row], value, to_double(radiosity[now]).v - to_double(radiosity[base]).v);
        });
}

/// Marks the rows of a layer from `first` on that gather from a column that changed.
void mark_reached(const LayeredRows& layer, std::size_t first, std::size_t last,
                  std::span<const std::uint8_t> changed, std::span<std::uint8_t> reached) {
    for (std::size_t row = first; row < last; ++row)
        for (std::uint64_t e = layer.base.row_begin[row]; e < layer.base.row_begin[row + 1]; ++e)
            reached[row - first] |= changed[layer.base.column[e]];
    for (std::size_t b = first / block_size; b < layer.covered.size() && b * block_size < last; ++b)
        for_covered(layer, b, [&](std::size_t row, Index base, Index now, float) {
            if (first <= row && row < last)
                reached[row - first] |= static_cast<std::uint8_t>(changed[now] | changed[base]);
        });
}

}  // namespace

void gather_rows(ResidualState& state, const ResidualProblem& problem, std::size_t first, std::size_t last) {
    gather_layer(problem.matrix.sight, first, last, state.radiosity, state.by_sight);
    gather_layer(problem.matrix.light, first, last, state.radiosity, state.by_light);
    // They began together; each is computed afresh in its own turn.
    for (std::size_t row = first; row < last; ++row)
        state.wear[row] = wear_each * static_cast<float>(row % most_additions);
}

void add_to_row(ResidualState& state, const ResidualProblem& problem, std::size_t row,
                const DoubleLanes& by_sight, const DoubleLanes& by_light) {
    if (!is_any(by_sight) && !is_any(by_light)) {
        // What only the fourth lane has got leaves the others their bits.
        state.by_sight[row].v[3] += by_sight.v[3];
        state.by_light[row].v[3] += by_light.v[3];
        return;
    }
    const auto largest = [](const DoubleLanes& light) {
        return std::max({std::abs(light.v[0]), std::abs(light.v[1]), std::abs(light.v[2])});
    };
    // What is on its way is rounded to float, relative to itself.
    const double share = std::max(largest(by_sight), largest(by_light)) /
                         std::max(largest(state.by_sight[row]), largest(state.by_light[row]));
    state.by_sight[row].v += by_sight.v;
    state.by_light[row].v += by_light.v;
    state.wear[row] += wear_each + static_cast<float>(share) / most_share;
    if (!(state.wear[row] < 1)) gather_rows(state, problem, row, row + 1);
}

void gather_all(ResidualState& state, const ResidualProblem& problem, const Context& context) {
    context.for_chunks(problem.matrix.rows(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
        gather_rows(state, problem, first, last);
    });
}

void gather_reached(ResidualState& state, const ResidualProblem& problem, std::span<const Lanes> change,
                    const Context& context) {
    std::vector<std::uint8_t> changed(change.size());
    for (std::size_t j = 0; j < change.size(); ++j) changed[j] = is_any(to_double(change[j])) ? 1 : 0;
    context.for_chunks(problem.matrix.rows(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
        std::vector<std::uint8_t> reached(last - first, 0);
        mark_reached(problem.matrix.sight, first, last, changed, reached);
        mark_reached(problem.matrix.light, first, last, changed, reached);
        // Rows that follow each other are gathered together: what is covered stands by block.
        for (std::size_t row = first; row < last; ++row) {
            const std::size_t begin = row;
            while (row < last && reached[row - first] != 0) ++row;
            if (row > begin) gather_rows(state, problem, begin, row);
        }
    });
}

void gather_whole(ResidualState& state, const ResidualProblem& problem, const Context& context) {
    state.by_whole.resize(problem.matrix.whole_rows.size());
    context.for_chunks(state.by_whole.size(), whole_rows_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
            state.by_whole[k] = gather_row(problem.matrix.whole, k, state.radiosity);
    });
}

}  // namespace afterglow
