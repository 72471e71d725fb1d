#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "service/http/router.h"

namespace afterglow {

/// Whether each request is told in one line on standard error.
enum class AccessLog { off, on };

struct HttpServerConfig {
    std::string address = "127.0.0.1";  ///< to listen on
    int port = 0;                       ///< 0: any free one
    std::size_t max_connections = 64;   ///< answered at a time, streams included; further ones wait
    std::size_t max_body_bytes = std::size_t{256} << 20U;  ///< also after decompression; larger ones are 413
    AccessLog access_log = AccessLog::off;                 ///< see AccessLog
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
    /// Ends: streams that have an end within two seconds at it, others at their next piece, other replies
    /// when they are sent. Returns when all is quiet.
    void stop();
    [[nodiscard]] bool is_running() const;

  private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace afterglow
