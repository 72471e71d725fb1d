#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/interrupt.h"

namespace afterglow::client {

/// Brings what the user wrote into the form "scheme://host[:port]": the scheme defaults to http, a final
/// slash goes. Errors: bad_input for other schemes, an empty host, a port outside 1 to 65,535, or a path.
std::string parse_server_url(std::string_view text);

/// Name and value; names compare without regard to case.
using HttpHeaders = std::vector<std::pair<std::string, std::string>>;

/// A complete reply.
struct HttpReply {
    int status = 0;
    HttpHeaders headers;
    std::string body;

    /// The first header of that name, or empty.
    [[nodiscard]] std::string header(std::string_view name) const;
};

/// What a receiver of a stream wants next.
enum class StreamNext { more, stop };
using StreamSink = std::function<StreamNext(std::string_view bytes)>;

/// How long to wait for the other side, and what to show it.
struct HttpConfig {
    std::chrono::seconds connect{5};  ///< to be connected
    std::chrono::seconds reply{
        120};  ///< for the next bytes of a reply; a big scene takes a while to be checked
    std::chrono::seconds stream{
        60};  ///< for the next bytes of a stream, several times the server's heartbeat
    std::chrono::seconds upload{60};  ///< for the server to take more bytes
    std::string token;                ///< shown to the server with every request; empty: none
};

/// A connection to one server, reused from request to request. The only user of cpp-httplib.
/// Every request throws ClientError{interrupted} after Ctrl-C, and ClientError{no_server} naming the server
/// where it cannot be reached or the connection breaks. HTTP errors are replies, not exceptions.
/// Thread-safety: one thread at a time; Ctrl-C may come at any time.
class HttpConnection {
  public:
    /// `server` as from parse_server_url. `interrupt` must outlive the connection.
    HttpConnection(std::string server, Interrupt& interrupt, HttpConfig config = {});
    ~HttpConnection();
    HttpConnection(const HttpConnection&) = delete;
    HttpConnection& operator=(const HttpConnection&) = delete;

    /// `path` begins with a slash and is percent-encoded.
    HttpReply get(const std::string& path, const HttpHeaders& headers = {});
    /// Status and headers only.
    HttpReply head(const std::string& path);
    HttpReply post(const std::string& path, std::string_view body, const std::string& content_type,
                   const HttpHeaders& headers = {});
    HttpReply put(const std::string& path, std::string_view body, const std::string& content_type);
    HttpReply patch(const std::string& path, std::string_view body, const std::string& content_type);
    /// DELETE.
    HttpReply remove(const std::string& path);
    /// Passes the body of a 200 reply on as it arrives, until it ends, breaks off or the sink says stop; the
    /// reply's own body is then empty. Any other status is returned whole. Throws no_server only where no
    /// reply began: a stream that breaks off returns normally, for the caller knows whether it was complete.
    HttpReply stream(const std::string& path, const HttpHeaders& headers, const StreamSink& sink);

    [[nodiscard]] const std::string& server() const { return server_; }

  private:
    struct Library;
    std::string server_;
    Interrupt& interrupt_;
    HttpConfig config_;
    std::unique_ptr<Library> library_;
};

}  // namespace afterglow::client
