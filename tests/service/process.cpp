#include "tests/service/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace afterglow::test {

namespace {

struct Pipe {
    Pipe() {
        if (::pipe2(ends.data(), O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe");
    }
    std::array<int, 2> ends{};
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> out;
    for (std::string& text : texts) out.push_back(text.data());
    out.push_back(nullptr);
    return out;
}

std::vector<std::string> full_environment(const std::vector<std::string>& additional) {
    std::vector<std::string> all = additional;  // the first of two equal names is the one that is found
    for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
    return all;
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
    const Pipe out;
    const Pipe err;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
    // Whoever runs the tests may ignore or block SIGINT; the program must start without that.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    sigset_t defaults;
    sigfillset(&defaults);
    posix_spawnattr_setsigdefault(&attributes, &defaults);

    std::vector<std::string> argument_texts = arguments;
    std::vector<std::string> environment_texts = full_environment(environment);
    const int error = ::posix_spawn(&pid_, arguments.at(0).c_str(), &actions, &attributes,
                                    pointers(argument_texts).data(), pointers(environment_texts).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    ::close(out.ends[1]);
    ::close(err.ends[1]);
    if (error != 0) {
        ::close(out.ends[0]);
        ::close(err.ends[0]);
        throw std::system_error(error, std::generic_category(), arguments[0]);
    }
    readers_.emplace_back([this, fd = out.ends[0]] { collect(fd, out_); });
    readers_.emplace_back([this, fd = err.ends[0]] { collect(fd, err_); });
}

Process::~Process() {
    if (!status_) {
        send_signal(SIGKILL);
        int status = 0;
        ::waitpid(pid_, &status, 0);
    }
    for (std::thread& reader : readers_)
        if (reader.joinable()) reader.join();
}

void Process::collect(int descriptor, std::string& into) {
    std::array<char, 4096> buffer{};
    for (;;) {
        const auto size = ::read(descriptor, buffer.data(), buffer.size());
        if (size < 0 && errno == EINTR) continue;
        const std::lock_guard lock(mutex_);
        if (size > 0) into.append(buffer.data(), static_cast<std::size_t>(size));
        if (size <= 0) --open_outputs_;
        changed_.notify_all();
        if (size <= 0) break;
    }
    ::close(descriptor);
}

void Process::send_signal(int number) const {
    if (!status_) ::kill(pid_, number);
}

std::vector<pid_t> Process::children() const {
    std::vector<pid_t> pids;
    std::error_code error;
    const std::filesystem::directory_iterator tasks("/proc/" + std::to_string(pid_) + "/task", error);
    for (const auto& task : tasks) {
        std::ifstream in(task.path() / "children");
        for (pid_t pid = 0; in >> pid;)
            if (is_running(pid)) pids.push_back(pid);
    }
    return pids;
}

void Process::reap(int status) {
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    for (std::thread& reader : readers_) reader.join();
    readers_.clear();
}

std::optional<int> Process::wait(std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!status_) {
        int status = 0;
        if (::waitpid(pid_, &status, WNOHANG) == pid_) {
            reap(status);
            break;
        }
        if (std::chrono::steady_clock::now() > deadline) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return status_;
}

bool Process::wait_for_output(const std::function<bool(const std::string&)>& condition,
                              std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [&] { return open_outputs_ == 0 || condition(out_); });
    return condition(out_);
}

bool is_running(pid_t pid) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
    std::string stat;
    std::getline(in, stat);
    const auto name_end = stat.rfind(')');
    return name_end != std::string::npos && stat.substr(name_end + 2, 1) != "Z";
}

std::string Process::out() const {
    const std::lock_guard lock(mutex_);
    return out_;
}

std::string Process::err() const {
    const std::lock_guard lock(mutex_);
    return err_;
}

}  // namespace afterglow::test
