#include "solver/radiosity/residual_sums.h"

#include <algorithm>
#include <cmath>

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 128;
// What is added at once has at most a thousand terms, each of them rounded to double.
constexpr double rounding_each = 0x1p-43;
// A row's sums are computed afresh when their rounding may come to this share of them, far below that of a
// sum just computed: so rounding never accumulates, nor does it stay behind when light goes out.
constexpr double most_wear = 0x1p-30;
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

double largest_of(const DoubleLanes& light) {
    return std::max({std::abs(light.v[0]), std::abs(light.v[1]), std::abs(light.v[2])});
}

/// Adds to a sum whose rounding is at most `wear` of it, and returns what it may be then: relative to less
/// light it is more.
double add(DoubleLanes& sum, const DoubleLanes& light, double wear) {
    const double before = largest_of(sum);
    sum.v += light.v;
    if (!is_any(light)) return wear;
    const double after = largest_of(sum);
    return (wear * before + rounding_each * std::max({before, after, largest_of(light)})) / after;
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
    std::fill(state.wear.begin() + static_cast<std::ptrdiff_t>(first),
              state.wear.begin() + static_cast<std::ptrdiff_t>(last), 0.0F);
}

void add_to_row(ResidualState& state, const ResidualProblem& problem, std::size_t row,
                const DoubleLanes& by_sight, const DoubleLanes& by_light) {
    if (!is_any(by_sight) && !is_any(by_light)) {
        // What only the fourth lane has got leaves the others their bits.
        state.by_sight[row].v[3] += by_sight.v[3];
        state.by_light[row].v[3] += by_light.v[3];
        return;
    }
    const double before = state.wear[row];
    const double wear =
        std::max(add(state.by_sight[row], by_sight, before), add(state.by_light[row], by_light, before));
    state.wear[row] = static_cast<float>(wear);
    if (!(wear < most_wear)) gather_rows(state, problem, row, row + 1);
}

void gather_all(ResidualState& state, const ResidualProblem& problem, const Context& context) {
    context.for_chunks(problem.matrix.rows(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
        gather_rows(state, problem, first, last);
    });
}

void gather_reached(ResidualState& state, const ResidualProblem& problem, std::span<const DoubleLanes> change,
                    const Context& context) {
    std::vector<std::uint8_t> changed(change.size());
    for (std::size_t j = 0; j < change.size(); ++j) changed[j] = is_any(change[j]) ? 1 : 0;
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
