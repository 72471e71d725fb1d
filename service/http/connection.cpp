#include "service/http/connection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>

#include "service/http/request_head.h"

namespace afterglow {

namespace {

using Clock = std::chrono::steady_clock;

/// Waits for events on a socket; 0 when the time is over.
short wait_for(int socket, short events, Clock::time_point until) {
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
        pollfd entry{socket, events, 0};
        const int ready = ::poll(&entry, 1, static_cast<int>(std::clamp<long>(left, 0, 3'600'000)));
        if (ready < 0 && errno == EINTR) continue;
        return ready <= 0 ? static_cast<short>(0) : entry.revents;
    }
}

bool has_closed(int socket) {
    char byte = 0;
    const auto size = ::recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return size == 0 || (size < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

}  // namespace

std::ptrdiff_t Connection::receive(char* to, std::size_t size, Clock::time_point until) const {
    for (;;) {
        const auto received = ::recv(socket_, to, size, MSG_DONTWAIT);
        if (received >= 0) return received;
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
        if (wait_for(socket_, POLLIN, until) == 0) return -1;
    }
}

Connection::HeadOutcome Connection::receive_head(std::size_t max_bytes) {
    const auto until = Clock::now() + patience_.head;
    std::array<char, 4096> part{};
    for (;;) {
        // Also where bytes keep coming, or a slow drip would never end.
        if (Clock::now() > until) return HeadOutcome::too_slow;
        const auto size = receive(part.data(), part.size(), until);
        if (size == 0) return HeadOutcome::closed;
        if (size < 0) return Clock::now() >= until ? HeadOutcome::too_slow : HeadOutcome::closed;
        head_.append(part.data(), static_cast<std::size_t>(size));
        if (const auto length = head_length(head_)) {
            ahead_ = head_.substr(*length);
            head_.resize(*length);
            return *length > max_bytes ? HeadOutcome::too_long : HeadOutcome::complete;
        }
        if (head_.size() > max_bytes) return HeadOutcome::too_long;
    }
}

std::ptrdiff_t Connection::read(char* to, std::size_t size) {
    if (!body_began_) body_began_ = Clock::now();
    // Whoever reads may hold back what it cannot make sense of, such as what follows a form's last boundary.
    if (body_bytes_ > patience_.body_bytes) return -1;
    std::ptrdiff_t received = 0;
    if (!ahead_.empty()) {
        const auto taken = ahead_.copy(to, size);
        ahead_.erase(0, taken);
        received = static_cast<std::ptrdiff_t>(taken);
    } else {
        const std::chrono::duration<double> earned(static_cast<double>(body_bytes_) /
                                                   patience_.body_bytes_per_s);
        const auto until = *body_began_ + patience_.body_start +
                           std::chrono::duration_cast<std::chrono::milliseconds>(earned);
        if (Clock::now() > until) return -1;
        received = receive(to, size, until);
    }
    if (received > 0) body_bytes_ += static_cast<std::size_t>(received);
    return received;
}

std::ptrdiff_t Connection::write(const char* from, std::size_t size) {
    std::size_t sent = 0;
    while (sent < size) {
        const auto part = ::send(socket_, from + sent, size - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (part > 0) {
            sent += static_cast<std::size_t>(part);
            continue;
        }
        if (part < 0 && errno == EINTR) continue;
        if (part < 0 && errno != EAGAIN && errno != EWOULDBLOCK) return -1;
        const short events = wait_for(socket_, POLLOUT, Clock::now() + patience_.write);
        if ((events & POLLOUT) == 0) return -1;
    }
    return static_cast<std::ptrdiff_t>(size);
}

bool Connection::is_writable() const {
    const short events = wait_for(socket_, POLLOUT, Clock::now() + patience_.write);
    return (events & POLLOUT) != 0 && (events & (POLLERR | POLLHUP)) == 0 && !has_closed(socket_);
}

bool Connection::is_readable() const {
    return !ahead_.empty() || wait_for(socket_, POLLIN, Clock::now() + patience_.body_start) != 0;
}

void Connection::finish() {
    ::shutdown(socket_, SHUT_WR);
    const auto until = Clock::now() + patience_.linger;
    std::array<char, 16384> rest{};
    while (Clock::now() < until && receive(rest.data(), rest.size(), until) > 0) {
    }
}

}  // namespace afterglow
