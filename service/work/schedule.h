#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace afterglow {

/// Whose turn it is. Jobs are admitted in the order they came, at most `max_resident` at a time; those
/// admitted take turns, one frame each. A job just admitted goes first, so that its first picture comes
/// early. Thread-safety: none.
class Schedule {
  public:
    /// `max_resident`: 1 or more; each resident job keeps its solver state in memory.
    explicit Schedule(std::size_t max_resident);

    void add(const std::string& job);
    /// Forgets a job, waiting or resident, so that another can be admitted. Unknown jobs are no error.
    void remove(const std::string& job);
    /// The job whose turn is next; it then goes to the end of the line. Nothing where there are no jobs.
    std::optional<std::string> next();

  private:
    std::size_t max_resident_;
    std::deque<std::string> waiting_;
    std::deque<std::string> resident_;  ///< the next turn is the front's
};

}  // namespace afterglow
