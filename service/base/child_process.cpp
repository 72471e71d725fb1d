#include "service/base/child_process.h"

#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <spawn.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "service/base/option_values.h"
#include "solver/base/error.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define AFTERGLOW_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define AFTERGLOW_SANITIZED
#endif
#endif

namespace afterglow {

namespace {

/// Where the kernel runs out of memory, a child goes before its parent.
constexpr const char* likely_victim = "500";

/// Only what the loader and sanitizers may need; above all nobody's secrets.
std::vector<std::string> child_environment() {
    std::vector<std::string> kept;
    for (const char* name : {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"})
        if (const char* value = std::getenv(name)) kept.push_back(std::string(name) + "=" + value);
    return kept;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> out;
    out.reserve(texts.size() + 1);
    for (std::string& text : texts) out.push_back(text.data());
    out.push_back(nullptr);
    return out;
}

/// What posix_spawn is told, freed at the end.
struct SpawnPlan {
    explicit SpawnPlan(int socket) {
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, socket, child_socket);
        posix_spawn_file_actions_addclosefrom_np(&actions, child_socket + 1);
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes,
                                 POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
        sigset_t set;
        sigfillset(&set);
        posix_spawnattr_setsigdefault(&attributes, &set);
        // A terminal or a service manager may tell the whole family to stop.
        sigemptyset(&set);
        sigaddset(&set, SIGINT);
        sigaddset(&set, SIGTERM);
        posix_spawnattr_setsigmask(&attributes, &set);
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
};

void limit(__rlimit_resource_t resource, rlim_t soft, rlim_t hard) {
    const rlimit both{soft, hard};
    if (::setrlimit(resource, &both) != 0)
        throw Error(ErrorKind::io, "limit", std::generic_category().message(errno));
}

#ifndef AFTERGLOW_SANITIZED
std::uint64_t address_space_bytes() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}
#endif

[[noreturn]] void end_without_memory() {
    try {
        if (const auto caught = std::current_exception()) std::rethrow_exception(caught);
    } catch (const std::bad_alloc&) {
        std::_Exit(status_out_of_memory);
    } catch (...) {
    }
    std::abort();
}

}  // namespace

std::string description_of(const ChildEnd& end) {
    if (end.signal == 0) return "exit status " + std::to_string(end.status);
    const char* name = ::sigabbrev_np(end.signal);
    return "signal " + std::to_string(end.signal) + (name != nullptr ? " (" + std::string(name) + ")" : "");
}

ChildProcess::ChildProcess(const ChildLimits& limits, const std::filesystem::path& program) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw Error(ErrorKind::io, "socketpair", std::generic_category().message(errno));
    const SpawnPlan plan(ends[1]);
    std::vector<std::string> arguments = {"afterglowd", child_command_name, std::to_string(::getpid()),
                                          std::to_string(limits.memory_bytes),
                                          std::to_string(limits.cpu.count())};
    std::vector<std::string> environment = child_environment();
    const int error = ::posix_spawn(&pid_, program.c_str(), &plan.actions, &plan.attributes,
                                    pointers(arguments).data(), pointers(environment).data());
    ::close(ends[1]);
    if (error != 0) {
        ::close(ends[0]);
        throw Error(ErrorKind::io, program.string(), std::generic_category().message(error));
    }
    socket_ = ends[0];
}

ChildProcess::~ChildProcess() {
    end();
    ::close(socket_);
}

void ChildProcess::kill() {
    // Once waited for, the number may be another process's.
    const std::lock_guard lock(mutex_);
    if (!waited_) ::kill(pid_, SIGKILL);
}

ChildEnd ChildProcess::end() {
    kill();
    // It stays a zombie until it is taken below, under the lock.
    siginfo_t ended{};
    while (::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
    }
    const std::lock_guard lock(mutex_);
    if (waited_) return end_;
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    waited_ = true;
    if (WIFSIGNALED(status)) end_.signal = WTERMSIG(status);
    if (WIFEXITED(status)) end_.status = WEXITSTATUS(status);
    return end_;
}

void become_child(std::span<const char* const> arguments) {
    if (arguments.size() != 3)
        throw Error(ErrorKind::invalid_input, child_command_name, "is for the service's own use");
    const auto number = [&](std::size_t i) {
        return whole_number(child_command_name, arguments[i], 0, std::numeric_limits<std::int64_t>::max());
    };
    std::set_terminate(end_without_memory);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // It may have ended before it could be tied to.
    if (::getppid() != number(0)) std::_Exit(1);
    std::ofstream("/proc/self/oom_score_adj") << likely_victim;
    limit(RLIMIT_CORE, 0, 0);
    // At the hard limit the signal would be SIGKILL, which does not say why.
    if (const auto cpu = static_cast<rlim_t>(number(2)); cpu > 0) limit(RLIMIT_CPU, cpu, cpu + 1);
#ifndef AFTERGLOW_SANITIZED  // sanitizers take terabytes of address space
    if (const auto memory = static_cast<rlim_t>(number(1)); memory > 0)
        limit(RLIMIT_AS, memory + address_space_bytes(), memory + address_space_bytes());
#endif
}

}  // namespace afterglow
