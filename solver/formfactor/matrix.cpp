#include "solver/formfactor/matrix.h"

#include <algorithm>
#include <string>

#include "solver/base/error.h"

namespace afterglow {

namespace {

void check_shape(const FormFactorMatrix& matrix) {
    const auto& begin = matrix.row_begin;
    const bool sound = !begin.empty() && begin.front() == 0 && begin.back() == matrix.column.size() &&
                       matrix.value.size() == matrix.column.size() &&
                       std::is_sorted(begin.begin(), begin.end());
    if (!sound) throw Error(ErrorKind::invalid_input, "form factors", "row offsets do not match the entries");
    if (matrix.rows() >= no_index) throw Error(ErrorKind::too_large, "form factors", "too many patches");
}

/// Cuts the rows into `parts` consecutive blocks of about equally many entries; returns parts + 1 row
/// numbers.
std::vector<std::size_t> cut_rows(const FormFactorMatrix& matrix, std::size_t parts) {
    std::vector<std::size_t> cut(parts + 1, matrix.rows());
    cut.front() = 0;
    for (std::size_t p = 1; p < parts; ++p) {
        const std::uint64_t entry = matrix.entries() / parts * p;
        const auto at = std::lower_bound(matrix.row_begin.begin(), matrix.row_begin.end(), entry);
        cut[p] = std::min(matrix.rows(), static_cast<std::size_t>(at - matrix.row_begin.begin()));
    }
    return cut;
}

/// Adds up how often each column stands in the entries [first, last).
void count_columns(const FormFactorMatrix& matrix, std::uint64_t first, std::uint64_t last,
                   std::span<std::uint64_t> count) {
    for (std::uint64_t e = first; e < last; ++e) {
        const Index column = matrix.column[e];
        if (column >= count.size())
            throw Error(ErrorKind::invalid_input, "form factor entry " + std::to_string(e),
                        "names patch " + std::to_string(column) + " of " + std::to_string(count.size()));
        ++count[column];
    }
}

/// Turns the counts of all blocks into the place where each block writes its first entry of each column.
std::vector<std::uint64_t> place_columns(std::vector<std::vector<std::uint64_t>>& counts,
                                         std::size_t columns) {
    std::vector<std::uint64_t> begin(columns + 1);
    std::uint64_t next = 0;
    for (std::size_t c = 0; c < columns; ++c) {
        begin[c] = next;
        for (auto& count : counts) {
            const std::uint64_t here = count[c];
            count[c] = next;
            next += here;
        }
    }
    begin[columns] = next;
    return begin;
}

/// Writes the entries of the rows [first, last), each to the next free place of its column.
void write_columns(const FormFactorMatrix& matrix, std::size_t first, std::size_t last,
                   std::span<std::uint64_t> next, FormFactorColumns& columns) {
    // Neighbouring entries go to places far apart; asking for those ahead of time saves a quarter to a half.
    constexpr std::uint64_t ahead = 16;
    const std::uint64_t last_entry = matrix.row_begin[last];
    for (std::size_t row = first; row < last; ++row)
        for (std::uint64_t e = matrix.row_begin[row]; e < matrix.row_begin[row + 1]; ++e) {
            const std::uint64_t soon = next[matrix.column[std::min(e + ahead, last_entry - 1)]];
            __builtin_prefetch(columns.row.data() + soon, 1);
            __builtin_prefetch(columns.value.data() + soon, 1);
            const std::uint64_t at = next[matrix.column[e]]++;
            columns.row[at] = static_cast<Index>(row);
            columns.value[at] = matrix.value[e];
        }
}

}  // namespace

FormFactorColumns columns_of(const FormFactorMatrix& matrix, const Context& context) {
    check_shape(matrix);
    const std::size_t patches = matrix.rows();
    // A counting sort that keeps the order of rows within a column, so the blocks' number leaves no trace.
    const auto parts = static_cast<std::size_t>(context.threads());
    const std::vector<std::size_t> cut = cut_rows(matrix, parts);
    std::vector<std::vector<std::uint64_t>> place(parts);
    context.for_chunks(parts, 1, [&](std::size_t p, std::size_t) {
        place[p].resize(patches);
        count_columns(matrix, matrix.row_begin[cut[p]], matrix.row_begin[cut[p + 1]], place[p]);
    });

    FormFactorColumns columns;
    columns.column_begin = place_columns(place, patches);
    columns.row.resize(matrix.entries());
    columns.value.resize(matrix.entries());
    context.for_chunks(parts, 1, [&](std::size_t p, std::size_t) {
        write_columns(matrix, cut[p], cut[p + 1], place[p], columns);
    });
    return columns;
}

}  // namespace afterglow
