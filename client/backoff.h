#pragma once

#include <chrono>
#include <optional>

namespace afterglow::client {

/// When to try again after a lost connection.
struct BackoffConfig {
    std::chrono::milliseconds first{250};     ///< wait before the first new attempt
    std::chrono::milliseconds longest{5000};  ///< the wait doubles up to this
    int attempts = 8;                         ///< attempts in a row before giving up, 0 or more
};

/// Counts failures in a row and says how long to wait. A value; one thread at a time.
class Backoff {
  public:
    explicit Backoff(BackoffConfig config = {}) : config_(config) {}

    /// The wait before the next attempt, or nothing when it is time to give up.
    std::optional<std::chrono::milliseconds> next();
    /// Something arrived: start from the beginning.
    void succeeded() { failures_ = 0; }
    /// Failures in a row so far.
    [[nodiscard]] int failures() const { return failures_; }

  private:
    BackoffConfig config_;
    int failures_ = 0;
};

}  // namespace afterglow::client
