#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "solver/base/context.h"
#include "solver/base/error.h"

namespace afterglow {

/// A text with every control character replaced by '?', so that a name out of a file can neither break a
/// line nor steer a terminal. Bytes past ASCII stay. Thread-safety: pure.
std::string one_line(std::string_view text);

/// Standard error of a command: warnings, and how far the work is. On a terminal progress is one redrawn
/// line; elsewhere a plain line is added every five seconds at most.
/// Thread-safety: every member may be called from any thread.
class Console {
  public:
    enum class Shows { progress, warnings_only };
    explicit Console(Shows shows);
    /// Takes the progress line away.
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// `subject` says which frame, for example "frame 3".
    void progress(std::string_view subject, const Progress& progress);
    /// Adds a line that stays, unless only warnings are shown.
    void line(std::string_view text);
    /// Adds "afterglowd: warning: place: message".
    void warning(const Warning& warning);

  private:
    using Clock = std::chrono::steady_clock;
    void add(const std::string& text);

    Shows shows_;
    bool is_terminal_;
    std::mutex mutex_;
    bool line_is_drawn_ = false;
    Clock::time_point last_progress_ = Clock::now();
};

}  // namespace afterglow
