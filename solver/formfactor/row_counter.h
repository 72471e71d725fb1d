#pragma once

#include <vector>

#include "solver/formfactor/matrix.h"

namespace afterglow {

/// Adds up one row after another, in which a column may be named many times. One thread at a time.
class RowCounter {
  public:
    explicit RowCounter(std::size_t columns) : sum_(columns, 0) {}

    /// `value` above 0.
    void add(Index column, float value) {
        if (sum_[column] == 0) touched_.push_back(column);
        sum_[column] += value;
    }
    /// Hands the row's columns, in the order in which they were first named, to `take(column, sum)`, and
    /// begins the next row.
    template <class Take>
    void end_row(const Take& take) {
        for (const Index column : touched_) {
            take(column, sum_[column]);
            sum_[column] = 0;
        }
        touched_.clear();
    }

  private:
    std::vector<float> sum_;  // by column, 0 but for those of the row in hand
    std::vector<Index> touched_;
};

}  // namespace afterglow
