#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/http/http_message.h"

namespace afterglow {

/// The values of a route's `{}` segments, in order.
using PathValues = std::vector<std::string>;
using Handler = std::function<Reply(const Request&, const PathValues&)>;

/// Finds the handler of a request. Thread-safety: `handle` may be called from any number of threads once
/// every route has been added.
class Router {
  public:
    /// `pattern` is a path whose segments are literal, or `{}` for any one segment.
    void add(std::string_view method, std::string_view pattern, Handler handler);

    /// Never throws: unknown paths are 404, other methods of known paths 405 with `Allow`, and whatever a
    /// handler throws becomes a problem. HEAD is answered as GET where it
    /// has no route of its own; the server leaves the body away.
    [[nodiscard]] Reply handle(const Request& request) const;

    /// Method and pattern of every route, in the order they were added.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> routes() const;

  private:
    struct Route {
        std::string method;
        std::vector<std::string> segments;
        Handler handler;
    };
    [[nodiscard]] const Route* find(std::string_view method, const std::vector<std::string>& segments,
                                    PathValues& values) const;
    [[nodiscard]] std::string allowed(const std::vector<std::string>& segments) const;

    std::vector<Route> routes_;
};

}  // namespace afterglow
