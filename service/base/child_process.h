#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <sys/types.h>

namespace afterglow {

/// What a child process may use.
struct ChildLimits {
    std::uint64_t memory_bytes = 0;  ///< of address space beyond what the program takes at its start; 0: any
    std::chrono::seconds cpu{0};     ///< processor time of all its threads; 0: any
};

/// How a child process ended.
struct ChildEnd {
    int status = 0;  ///< exit status where no signal ended it
    int signal = 0;  ///< 0: it ended by itself
};

/// The exit status of a child that could not even say that it has no more memory.
inline constexpr int status_out_of_memory = 77;

/// "signal 11 (SEGV)" or "exit status 3".
std::string description_of(const ChildEnd& end);

/// The command by which the program starts itself as a child, and where a child finds its socket.
inline constexpr const char* child_command_name = "child";
inline constexpr int child_socket = 3;

/// Another process of this program, joined to it by a stream socket: what happens to it happens to it alone.
/// It starts from a fresh exec (threads make anything else unsafe), in a process group of its own, with no
/// descriptors but the socket and standard error, almost no environment, and SIGINT and SIGTERM blocked: the
/// parent decides when it ends. Killed when the object goes, or when the thread that made it ends.
/// Thread-safety: `kill` from any thread; the rest one thread at a time.
class ChildProcess {
  public:
    /// `program`: this one unless a test puts another in its place. Errors: io where it cannot be started.
    explicit ChildProcess(const ChildLimits& limits, const std::filesystem::path& program = "/proc/self/exe");
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] int socket() const { return socket_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Ends it at once. Nothing where it has been waited for.
    void kill();
    /// Kills it unless it has ended, and says how it did.
    ChildEnd end();

  private:
    std::mutex mutex_;
    int socket_ = -1;
    pid_t pid_ = -1;
    bool waited_ = false;
    ChildEnd end_;
};

/// In the child, from the arguments after the command: takes on its limits and ties its life to its parent's.
/// Where memory runs out in a place that cannot fail it ends with `status_out_of_memory`. Errors:
/// invalid_input for arguments that no parent gives.
void become_child(std::span<const char* const> arguments);

}  // namespace afterglow
