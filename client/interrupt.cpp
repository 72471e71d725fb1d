#include "client/interrupt.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "client/error.h"

namespace afterglow::client {

namespace {

sigset_t only_sigint() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    return set;
}

int checked(int descriptor) {
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "cannot watch for Ctrl-C");
    return descriptor;
}

void signal_event(int descriptor) {
    const std::uint64_t one = 1;
    // An eventfd refuses a write only when its counter is full, and then it is readable already.
    [[maybe_unused]] const auto written = ::write(descriptor, &one, sizeof one);
}

}  // namespace

Interrupt::Interrupt() {
    const sigset_t set = only_sigint();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    signal_fd_ = checked(::signalfd(-1, &set, SFD_CLOEXEC));
    woken_fd_ = checked(::eventfd(0, EFD_CLOEXEC));
    closing_fd_ = checked(::eventfd(0, EFD_CLOEXEC));
    thread_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
    signal_event(closing_fd_);
    thread_.join();
    for (const int descriptor : {signal_fd_, woken_fd_, closing_fd_}) ::close(descriptor);
    const sigset_t set = only_sigint();
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void Interrupt::set_action(const void* owner, std::function<void()> action) {
    const std::lock_guard lock(mutex_);
    if (action)
        actions_[owner] = std::move(action);
    else
        actions_.erase(owner);
}

void Interrupt::sleep(std::chrono::milliseconds duration) const {
    pollfd woken{woken_fd_, POLLIN, 0};
    ::poll(&woken, 1, static_cast<int>(duration.count()));
}

void Interrupt::check() const {
    if (requested()) throw ClientError(ExitCode::interrupted, "", "interrupted");
}

void Interrupt::listen() {
    // The action runs again and again: the first call may come just before the request it should stop begins.
    constexpr int repeat_ms = 100;
    for (;;) {
        std::array<pollfd, 2> fds{{{signal_fd_, POLLIN, 0}, {closing_fd_, POLLIN, 0}}};
        ::poll(fds.data(), fds.size(), requested() ? repeat_ms : -1);
        if ((fds[1].revents & POLLIN) != 0) return;
        if ((fds[0].revents & POLLIN) != 0) {
            signalfd_siginfo info{};
            if (::read(signal_fd_, &info, sizeof info) < 0) continue;
            if (requested_.exchange(true)) ::_exit(static_cast<int>(ExitCode::interrupted));
            signal_event(woken_fd_);
        }
        if (!requested()) continue;
        const std::lock_guard lock(mutex_);
        for (const auto& [owner, action] : actions_) action();
    }
}

}  // namespace afterglow::client
