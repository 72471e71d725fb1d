#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace afterglow {

/// A set of threads that share out numbered tasks.
/// Purpose: the one place that knows the library of parallel loops; `Context` is what steps are given.
/// Thread-safety: const calls may come from any thread, also from inside a task.
class Threads {
  public:
    /// `count`: 1 or more.
    explicit Threads(int count);

    [[nodiscard]] int count() const;

    /// Calls `task(0)` … `task(tasks - 1)`, each once, in any order, and returns when all have ended.
    /// Errors: the first exception of a task is thrown on; tasks not begun by then may be left out.
    void for_each(std::size_t tasks, const std::function<void(std::size_t)>& task) const;

  private:
    struct Arena;
    std::shared_ptr<Arena> arena_;
};

}  // namespace afterglow
