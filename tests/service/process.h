#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <sys/types.h>
#include <thread>
#include <vector>

namespace afterglow::test {

/// A limit after which something that should have happened never will: far above any run on a busy machine,
/// so that no test depends on speed.
inline constexpr std::chrono::seconds patience{300};

/// A running program whose two outputs are collected. Killed, if it still runs, when the object goes.
/// Thread-safety: one thread at a time.
class Process {
  public:
    /// `arguments[0]` is the program's path; `environment` has additional NAME=value entries.
    /// Errors: std::system_error where it cannot be started.
    explicit Process(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& environment = {});
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send_signal(int number) const;
    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Processes that it has started and that still run.
    [[nodiscard]] std::vector<pid_t> children() const;
    /// Exit status, or 128 + number where a signal ended it; nothing where it still runs after the limit.
    std::optional<int> wait(std::chrono::milliseconds limit = patience);
    /// Waits until what was written to standard output fulfils the condition. False where the program ended,
    /// or the limit passed, before it did.
    bool wait_for_output(const std::function<bool(const std::string&)>& condition,
                         std::chrono::milliseconds limit = patience);

    /// All that was written so far; complete after `wait`.
    std::string out() const;
    std::string err() const;

  private:
    void collect(int descriptor, std::string& into);
    void reap(int status);

    pid_t pid_ = -1;
    std::optional<int> status_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::string out_;
    std::string err_;
    int open_outputs_ = 2;
    std::vector<std::thread> readers_;
};

/// Whether a process runs; one that has ended and is waited for by nobody does not.
bool is_running(pid_t pid);

}  // namespace afterglow::test
