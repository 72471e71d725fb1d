#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/math.h"

namespace afterglow {

/// Form factors F_ij as sparse rows: row i holds what receiver i sees. Rows need not be sorted by column; a
/// column may stand in a row more than once (the values then add up). Row sums are at most 1 up to rounding.
struct FormFactorMatrix {
    std::vector<std::uint64_t> row_begin{0};  ///< size rows + 1
    std::vector<Index> column;                ///< the patch seen
    std::vector<float> value;                 ///< F_ij > 0, one a column entry

    [[nodiscard]] std::size_t rows() const { return row_begin.size() - 1; }
    [[nodiscard]] std::size_t entries() const { return column.size(); }
};

/// The same entries by column: which receivers see patch j, and by how much. Shooting walks these.
struct FormFactorColumns {
    std::vector<std::uint64_t> column_begin{0};  ///< size columns + 1
    std::vector<Index> row;                      ///< receivers, in increasing order within a column
    std::vector<float> value;                    ///< F_row,column
};

/// Transposes a square matrix. Same result for any number of threads.
FormFactorColumns columns_of(const FormFactorMatrix& matrix, const Context& context);

}  // namespace afterglow
