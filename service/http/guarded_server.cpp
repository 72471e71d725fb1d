#include "service/http/guarded_server.h"

#include <optional>
#include <utility>

#include "service/http/chunk_guard.h"
#include "service/http/http_message.h"

namespace afterglow {

namespace {

constexpr int backlog = 512;
// Connections past the number wait this long for a place, on one of a few threads more, before they are
// refused: a burst of short requests is then served late and not at all only when it lasts.
constexpr std::chrono::milliseconds place_wait{1'000};
constexpr std::size_t waiting_threads = 32;

/// The library's default also sets SO_REUSEPORT, with which two servers share a port and each gets some of
/// the requests; here the second one must fail.
void set_socket_options(socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// A received head, then the body from the socket.
class GuardedStream : public httplib::Stream {
  public:
    GuardedStream(Connection& connection, std::string head)
        : connection_(connection), head_(std::move(head)) {
        if (is_chunked(head_)) chunks_.emplace();
    }

    [[nodiscard]] bool is_readable() const override {
        return used_ < head_.size() || connection_.is_readable();
    }
    [[nodiscard]] bool is_writable() const override { return connection_.is_writable(); }
    ssize_t read(char* to, std::size_t size) override {
        if (used_ == head_.size()) {
            const auto received = connection_.read(to, size);
            if (received <= 0 || !chunks_) return received;
            return chunks_->take({to, static_cast<std::size_t>(received)}) ? received : -1;
        }
        const auto taken = head_.copy(to, size, used_);
        used_ += taken;
        return static_cast<ssize_t>(taken);
    }
    ssize_t write(const char* from, std::size_t size) override { return connection_.write(from, size); }
    void get_remote_ip_and_port(std::string& ip, int& port) const override { ip.clear(), port = 0; }
    void get_local_ip_and_port(std::string& ip, int& port) const override { ip.clear(), port = 0; }
    [[nodiscard]] socket_t socket() const override { return connection_.socket(); }

  private:
    Connection& connection_;
    std::string head_;
    std::size_t used_ = 0;
    std::optional<ChunkGuard> chunks_;
};

std::string reply_text(const Problem& problem, const std::string& more_headers = "") {
    const Reply reply = problem_reply(problem);
    return "HTTP/1.1 " + std::to_string(problem.status) + " " + std::string(title_of(problem.status)) +
           "\r\nContent-Type: " + reply.content_type +
           "\r\nContent-Length: " + std::to_string(reply.body.size()) + "\r\nConnection: close\r\n" +
           more_headers + "\r\n" + reply.body;
}

const Problem no_place{503, "too_many_connections", "too many connections; try again", ""};
constexpr const char* retry_soon = "Retry-After: 1\r\n";

}  // namespace

/// Gives each accepted connection to the elastic threads. The library owns it and deletes it.
class GuardedServer::Threads : public httplib::TaskQueue {
  public:
    explicit Threads(GuardedServer& server) : server_(server) {}
    void enqueue(std::function<void()> task) override {
        if (server_.listener_ == std::thread::id()) server_.listener_ = std::this_thread::get_id();
        if (server_.threads_.run([task, keep = server_.keep_.lock()] { task(); })) return;
        // Not even a thread to say no from: here the task says so and closes.
        task();
    }
    void shutdown() override {}

  private:
    GuardedServer& server_;
};

GuardedServer::GuardedServer(GuardConfig config)
    : config_(config), threads_(config.max_connections + waiting_threads) {
    set_socket_options(afterglow::set_socket_options);
    set_tcp_nodelay(true);  // events are small and must not wait for each other
    new_task_queue = [this] { return new Threads(*this); };
}

int GuardedServer::bind(const std::string& address, int port) {
    const int bound = port == 0 ? bind_to_any_port(address) : bind_to_port(address, port) ? port : -1;
    // The library listens with a backlog of five, which a burst of clients overflows.
    if (bound >= 0) ::listen(svr_sock_, backlog);
    return bound;
}

void GuardedServer::stop_listening() {
    Server::stop();
}

bool GuardedServer::end_connections(std::chrono::milliseconds grace) {
    if (threads_.wait_until_idle(grace)) return true;
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        for (const socket_t socket : open_) ::shutdown(socket, SHUT_RDWR);
    }
    changed_.notify_all();
    return threads_.wait_until_idle(grace);
}

bool GuardedServer::wait_for_place() {
    std::unique_lock lock(mutex_);
    const auto has_place = [&] { return ending_ || answering_ < config_.max_connections; };
    if (!changed_.wait_for(lock, place_wait, has_place) || ending_) return false;
    ++answering_;
    return true;
}

void GuardedServer::leave_place() {
    {
        const std::lock_guard lock(mutex_);
        --answering_;
    }
    changed_.notify_one();
}

bool GuardedServer::process_and_close_socket(socket_t socket) {
    bool is_ending = false;
    {
        const std::lock_guard lock(mutex_);
        open_.insert(socket);
        is_ending = ending_;
    }
    Connection connection(socket, config_.patience);
    bool answered = false;
    if (std::this_thread::get_id() == listener_) {
        refuse_at_once(socket);
    } else if (!is_ending && wait_for_place()) {
        try {
            answered = answer(connection);
        } catch (...) {
            answered = false;  // out of memory: this connection ends, the others go on
        }
        leave_place();
    } else if (!is_ending) {
        refuse(connection, no_place);
    }
    const std::lock_guard lock(mutex_);
    open_.erase(socket);
    ::close(socket);
    return answered;
}

bool GuardedServer::answer(Connection& connection) {
    switch (connection.receive_head(config_.head.bytes)) {
        case Connection::HeadOutcome::closed:
            return false;
        case Connection::HeadOutcome::too_slow:
            if (!connection.head().empty())
                refuse(connection, {408, "request_timeout", "the request took too long to arrive", ""});
            return false;
        case Connection::HeadOutcome::too_long:
            refuse(connection, connection.head().find('\n') == std::string::npos
                                   ? Problem{414, "target_too_long", "the address is too long", ""}
                                   : Problem{431, "headers_too_large", "the header is too long", ""});
            return false;
        case Connection::HeadOutcome::complete:
            break;
    }
    if (const auto problem = problem_of_head(connection.head(), config_.head)) {
        refuse(connection, *problem);
        return false;
    }
    GuardedStream stream(connection, without_ranges(connection.head()));
    bool closed = false;
    const bool answered = process_request(stream, true, closed, nullptr);
    connection.finish();
    return answered;
}

void GuardedServer::refuse(Connection& connection, const Problem& problem) const {
    const std::string text = reply_text(problem, problem.status == 503 ? retry_soon : "");
    connection.write(text.data(), text.size());
    connection.finish();
}

void GuardedServer::refuse_at_once(socket_t socket) const {
    const std::string text = reply_text(no_place, retry_soon);
    ::send(socket, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    ::shutdown(socket, SHUT_WR);
}

}  // namespace afterglow
