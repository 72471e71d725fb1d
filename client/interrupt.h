#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace afterglow::client {

/// Turns Ctrl-C (SIGINT) into an orderly stop. While one exists SIGINT does not end the process: it sets a
/// flag, wakes `sleep`, and calls the stop action until the object goes. A second SIGINT exits at once with
/// ExitCode::interrupted. Make it in main before any other thread, since it works by masking the signal.
/// Thread-safety: all members may be called from any thread. Errors: std::system_error where the system has
/// no descriptors or threads left.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    [[nodiscard]] bool requested() const { return requested_.load(); }
    /// What to do on Ctrl-C, from another thread, perhaps several times: unblock whatever waits. One action
    /// for each owner; an empty one removes it, and does not return while it runs.
    void set_action(const void* owner, std::function<void()> action);
    /// Waits; returns early on Ctrl-C.
    void sleep(std::chrono::milliseconds duration) const;
    /// Throws ClientError{interrupted} once Ctrl-C was pressed.
    void check() const;

  private:
    void listen();

    std::atomic<bool> requested_{false};
    std::mutex mutex_;
    std::map<const void*, std::function<void()>> actions_;
    int signal_fd_ = -1;   ///< readable when SIGINT came
    int woken_fd_ = -1;    ///< eventfd, readable for ever once SIGINT came
    int closing_fd_ = -1;  ///< eventfd, readable once the object goes
    std::thread thread_;
};

}  // namespace afterglow::client
