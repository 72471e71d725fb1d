#include "solver/radiosity/residual_sums.h"

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 128;
constexpr std::size_t whole_rows_per_chunk = 64;

/// What rows of a layer gather, computed afresh.
void gather_layer(const LayeredRows& layer, std::size_t first, std::size_t last,
                  std::span<const Lanes> radiosity, std::vector<DoubleLanes>& sums) {
    for (std::size_t row = first; row < last; ++row) sums[row] = gather_row(layer.base, row, radiosity);
    for (std::size_t near = first; near < last; near = (near / block_size + 1) * block_size)
        for (const CoveredEntry& entry : layer.covered_near(near))
            if (first <= entry.row && entry.row < last)
                add_light(sums[entry.row], entry.value,
                          to_double(radiosity[entry.now]).v - to_double(radiosity[entry.base]).v);
}

}  // namespace

void gather_rows(ResidualState& state, const ResidualProblem& problem, std::size_t first, std::size_t last) {
    gather_layer(problem.matrix.sight, first, last, state.radiosity, state.by_sight);
    gather_layer(problem.matrix.light, first, last, state.radiosity, state.by_light);
    // They began together; each is computed afresh in its own turn.
    for (std::size_t row = first; row < last; ++row)
        state.wear[row] = static_cast<std::uint8_t>(row % most_wear);
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
    const auto reaches = [&](const LayeredRows& layer, std::size_t row) {
        for (std::uint64_t e = layer.base.row_begin[row]; e < layer.base.row_begin[row + 1]; ++e)
            if (changed[layer.base.column[e]] != 0) return true;
        for (const CoveredEntry& entry : layer.covered_near(row))
            if (entry.row == row && (changed[entry.now] | changed[entry.base]) != 0) return true;
        return false;
    };
    context.for_chunks(problem.matrix.rows(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t row = first; row < last; ++row)
            if (reaches(problem.matrix.sight, row) || reaches(problem.matrix.light, row))
                gather_rows(state, problem, row, row + 1);
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
