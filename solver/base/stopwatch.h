#pragma once

#include <chrono>

namespace afterglow {

using Milliseconds = std::chrono::duration<double, std::milli>;

/// Time since it was made.
class Stopwatch {
  public:
    [[nodiscard]] Milliseconds elapsed() const { return std::chrono::steady_clock::now() - start_; }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace afterglow
