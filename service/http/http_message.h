#pragma once

// Requests and replies between the routes and the HTTP server, so that routes know nothing of sockets.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/base/problem.h"
#include "service/http/client.h"
#include "solver/base/json.h"

namespace afterglow {

/// A field of a form (RFC 7578).
struct FormPart {
    std::string name;
    std::string file_name;  ///< empty: none given
    std::string body;
};

/// A request, received whole. A value.
struct Request {
    std::string method;                          ///< upper case
    std::string path;                            ///< percent-decoded, without the query
    std::map<std::string, std::string> query;    ///< decoded; of repeated names the first
    std::map<std::string, std::string> headers;  ///< names in lower case; of repeated names the first
    std::string body;
    std::vector<FormPart> parts = {};  ///< of a form, whose body is then empty
    Client client = {};                ///< as the gate found

    /// A header by its lower-case name, or a query parameter; empty where there is none.
    [[nodiscard]] std::string header(const std::string& name) const;
    [[nodiscard]] std::string parameter(const std::string& name) const;
    /// The media type in lower case without its parameters.
    [[nodiscard]] std::string media_type() const;
};

/// A piece of a streamed reply body; may be empty, which lets the server look whether the reader is still
/// there.
struct Piece {
    enum class Then { more, end };
    std::string bytes;
    Then then = Then::more;
};

/// A reply body made piece by piece. `next` waits at most about a second. One thread at a time.
class ReplyStream {
  public:
    virtual ~ReplyStream() = default;
    virtual Piece next() = 0;
};

/// A reply: a body, or a stream.
struct Reply {
    int status = 200;
    std::string content_type;
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers;
    std::shared_ptr<ReplyStream> stream;  ///< replaces the body where set
};

/// JSON as text; bytes that are not UTF-8 are replaced, never thrown over.
std::string dump(const Json& json);

/// A JSON reply, and a problem as `application/problem+json`.
Reply json_reply(const Json& json, int status = 200);
Reply problem_reply(const Problem& problem);

}  // namespace afterglow
