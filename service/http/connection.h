#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace afterglow {

/// How long a peer may take.
struct Patience {
    std::chrono::milliseconds head{10'000};            ///< for the whole head of a request
    std::chrono::milliseconds body_start{10'000};      ///< a body may be this much behind its least rate
    std::size_t body_bytes = std::size_t{513} << 20U;  ///< as sent; past it nothing more is read
    double body_bytes_per_s = 4096;                    ///< least rate of a body; 256 MiB would then take 18 h
    std::chrono::milliseconds write{8'000};            ///< for a reader to take anything at all
    std::chrono::milliseconds linger{2'000};  ///< for a peer to take a reply that came before it was done
};

/// A connected socket with limits on how long its peer may take. Closed by its owner, not by this class.
/// Thread-safety: one thread at a time; another may shut the socket down, which ends every wait.
class Connection {
  public:
    Connection(int socket, const Patience& patience) : socket_(socket), patience_(patience) {}

    enum class HeadOutcome { complete, closed, too_slow, too_long };
    /// Receives until the head is whole; what came after it is kept for `read`. Past `max_bytes` it stops.
    HeadOutcome receive_head(std::size_t max_bytes);
    /// As received so far.
    [[nodiscard]] const std::string& head() const { return head_; }

    /// Bytes of the body; 0: the peer has closed; −1: failed, or slower than the least rate.
    std::ptrdiff_t read(char* to, std::size_t size);
    /// Sends all; −1 where the peer takes nothing for too long or is gone.
    std::ptrdiff_t write(const char* from, std::size_t size);
    /// Waits until something can be written; false where it cannot, or the peer has closed.
    [[nodiscard]] bool is_writable() const;
    [[nodiscard]] bool is_readable() const;
    /// Ends the reply and waits a little for the peer to take it: closing while bytes of the request are
    /// unread would destroy a reply on its way.
    void finish();
    [[nodiscard]] int socket() const { return socket_; }

  private:
    using Clock = std::chrono::steady_clock;
    std::ptrdiff_t receive(char* to, std::size_t size, Clock::time_point until) const;

    int socket_;
    Patience patience_;
    std::string head_;
    std::string ahead_;  ///< received with the head, belongs to the body
    std::optional<Clock::time_point> body_began_;
    std::size_t body_bytes_ = 0;
};

}  // namespace afterglow
