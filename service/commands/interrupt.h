#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

namespace afterglow {

/// Turns the first SIGINT or SIGTERM into a request to stop; the second ends the process at once.
/// Purpose: work ends at a clean place, with nothing half-written. Make one at the start of the program,
/// before other threads exist, since they inherit which signals are blocked. At most one at a time.
/// Thread-safety: const members may be called from any thread.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
    /// The signal that came, or 0.
    [[nodiscard]] int signal() const { return signal_; }

  private:
    void wait();

    std::stop_source stop_;
    std::atomic<int> signal_ = 0;
    std::atomic<bool> closing_ = false;
    std::thread waiting_;
};

}  // namespace afterglow
