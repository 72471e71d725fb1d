#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <httplib.h>

#include "service/http/connection.h"
#include "service/http/elastic_threads.h"
#include "service/http/request_head.h"

namespace afterglow {

struct GuardConfig {
    std::size_t max_connections = 256;  ///< answered at a time, streams included; more are told 503
    Patience patience;                  ///< how long a peer may take
    HeadLimits head;                    ///< what a request's head may be
};

/// The library's server with every connection under guard. The library reads heads without an end, keeps
/// connections on a fixed pool of threads, lets framing contradict itself and unpacks bodies to any size;
/// here a head is received and judged before the library sees it, each connection carries one request and
/// has a thread of its own up to a number, and all of them can be shut down.
class GuardedServer : public httplib::Server {
  public:
    explicit GuardedServer(GuardConfig config);

    /// What every connection keeps alive while it lasts, such as the owner of this server.
    void keep(std::weak_ptr<void> owner) { keep_ = std::move(owner); }
    /// Binds and listens with a backlog for bursts; the port, or −1. Port 0: any free one.
    int bind(const std::string& address, int port);
    /// No new connections; those open go on.
    void stop_listening();
    /// Waits until all connections have ended; shuts them down after `grace`, and after another `grace`
    /// leaves those that still sleep to end by themselves: true where there are none.
    bool end_connections(std::chrono::milliseconds grace);

  private:
    class Threads;
    friend class Threads;
    bool process_and_close_socket(socket_t socket) override;
    bool answer(Connection& connection);
    bool wait_for_place();
    void leave_place();
    void refuse(Connection& connection, const Problem& problem) const;
    void refuse_at_once(socket_t socket) const;

    GuardConfig config_;
    ElasticThreads threads_;
    std::weak_ptr<void> keep_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::set<socket_t> open_;
    std::thread::id listener_;  ///< set before any other thread of this server begins
    std::size_t answering_ = 0;
    bool ending_ = false;
};

}  // namespace afterglow
