#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>

namespace afterglow {

/// As many threads as there is work, up to a number: one for each task, gone with it. A task that sleeps
/// never holds another one up. Thread-safety: all members.
class ElasticThreads {
  public:
    explicit ElasticThreads(std::size_t max_threads);

    /// Runs the task on a thread of its own; false where there are too many, or no more can be had.
    bool run(std::function<void()> task);
    [[nodiscard]] std::size_t active() const;
    /// Waits until no task runs. False: some still do after `limit`; they go on by themselves.
    bool wait_until_idle(std::chrono::milliseconds limit) const;

  private:
    /// Outlives this object as long as a task runs.
    struct Shared {
        std::mutex mutex;
        std::condition_variable changed;
        std::size_t active = 0;
    };
    std::size_t max_threads_;
    std::shared_ptr<Shared> shared_;
};

}  // namespace afterglow
