#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "service/http/connection.h"
#include "service/http/router.h"

namespace afterglow {

/// Whether each request is told in one line on standard error.
enum class AccessLog { off, on };

/// Looks at a request before its body is received, may note who it comes from, and returns a reply where it
/// is refused. Called from any number of threads.
using Gate = std::function<std::optional<Reply>(Request&)>;

/// Looks at how much of a body has been announced, and again at how much has come, and returns a reply where
/// that is too much for this request. Called from any number of threads.
using BodyCheck = std::function<std::optional<Reply>(const Request&, std::size_t bytes)>;

struct HttpServerConfig {
    std::string address = "127.0.0.1";  ///< to listen on
    int port = 0;                       ///< 0: any free one
    std::size_t max_connections = 256;  ///< answered at a time, streams included; more are told 503
    std::size_t max_body_bytes = std::size_t{256} << 20U;  ///< also after decompression; larger ones are 413
    AccessLog access_log = AccessLog::off;                 ///< see AccessLog
    Patience patience = {};                                ///< how long a peer may take
    std::size_t max_streams = 192;                         ///< open at a time; more are told 503
    Gate gate = {};                                        ///< may refuse a request; empty: none is refused
    BodyCheck body_check = {};                             ///< may refuse a body; empty: none is refused
};

/// Carries requests to a router and its replies back. The only user of the HTTP library.
/// Thread-safety: `stop` and `is_running` from any thread.
class HttpServer {
  public:
    /// The router must outlive the server.
    HttpServer(const Router& router, HttpServerConfig config);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// Takes the address and begins to answer; returns the port. Errors: io where the address cannot be had,
    /// for example because another program listens there.
    int start();
    /// Ends within seconds whatever the peers do: streams that have an end within two seconds at it, all
    /// other connections are then shut down. A provider that sleeps on is left to itself.
    void stop();
    [[nodiscard]] bool is_running() const;

  private:
    class Parts;
    std::shared_ptr<Parts> parts_;
};

}  // namespace afterglow
