#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>

namespace afterglow {

/// Whose turn it is: always a job of the highest priority that there is. Among those jobs are admitted in the
/// order they came, at most `max_resident` at a time; those admitted take turns, one frame each. A job just
/// admitted goes first, so that its first picture comes early. One that waits takes the place of one of lower
/// priority, which then waits in front of its equals. Thread-safety: none.
class Schedule {
  public:
    /// `max_resident`: 1 or more; each resident job keeps its solver state in memory.
    explicit Schedule(std::size_t max_resident);

    void add(const std::string& job);
    /// Forgets a job, waiting or resident, so that another can be admitted. Unknown jobs are no error.
    void remove(const std::string& job);
    /// The same, with its priority.
    void forget(const std::string& job);
    [[nodiscard]] bool contains(const std::string& job) const;
    /// Higher goes first; 0 where it was never set. It holds until the job is forgotten.
    void set_priority(const std::string& job, int priority);
    /// Whether it may keep its solver state: admitted, and not displaced since.
    [[nodiscard]] bool is_resident(const std::string& job) const;
    /// The job whose turn is next; it then goes to the end of the line. Nothing where there are no jobs.
    std::optional<std::string> next();

  private:
    using Line = std::deque<std::string>;
    [[nodiscard]] int priority_of(const std::string& job) const;
    Line::iterator first_in(Line& line) const;
    void admit();

    std::size_t max_resident_;
    Line waiting_;
    Line resident_;  ///< the next turn is that of the first of the highest priority
    std::map<std::string, int> priorities_;
};

}  // namespace afterglow
