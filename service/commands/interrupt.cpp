#include "service/commands/interrupt.h"

#include <csignal>
#include <pthread.h>

namespace afterglow {

namespace {

sigset_t stop_signals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    return set;
}

}  // namespace

Interrupt::Interrupt() {
    const sigset_t set = stop_signals();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    waiting_ = std::thread([this] { wait(); });
}

Interrupt::~Interrupt() {
    closing_ = true;
    pthread_kill(waiting_.native_handle(), SIGINT);
    waiting_.join();
}

void Interrupt::wait() {
    const sigset_t set = stop_signals();
    for (;;) {
        int signal = 0;
        sigwait(&set, &signal);
        if (closing_) return;
        if (signal_ != 0) break;
        signal_ = signal;
        stop_.request_stop();
    }
    // Whoever insists is obeyed.
    std::signal(signal_, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    std::raise(signal_);
}

}  // namespace afterglow
