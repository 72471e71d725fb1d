#pragma once

#include <chrono>

#include "solver/sequence/sequence.h"

namespace afterglow {

/// Time since it was made.
class Stopwatch {
  public:
    [[nodiscard]] Milliseconds elapsed() const { return std::chrono::steady_clock::now() - start_; }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace afterglow
