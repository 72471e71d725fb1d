#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "service/base/problem.h"

namespace afterglow {

struct HeadLimits {
    std::size_t bytes = std::size_t{64} << 10U;        ///< request line and fields together; more is 431
    std::size_t fields = 100;                          ///< header fields; more is 431
    std::size_t target_bytes = 8000;                   ///< of the request line; more is 414
    std::size_t field_bytes = 8000;                    ///< one header field; more is 431
    std::size_t body_bytes = std::size_t{256} << 20U;  ///< announced by Content-Length; more is 413
};

/// Whether a head without problems announces a chunked body.
bool is_chunked(std::string_view head);

/// The length of a request's head, its empty line included, once all of it is there. A line may end with a
/// bare line feed here; `problem_of_head` refuses it.
std::optional<std::size_t> head_length(std::string_view received);

/// Whether a head may be handed on: a problem where it is malformed, too long, or says more than one thing
/// about where its body ends, so that two readers could disagree about it; also for encodings that are not
/// unpacked here. Everything is decided before any of the body is read. Sources: RFC 9112 §2–6, RFC 9110.
/// Thread-safety: pure; any bytes are allowed.
std::optional<Problem> problem_of_head(std::string_view head, const HeadLimits& limits);

/// The head without its Range fields: replies are sent whole (RFC 9110 §14.2), however many are asked for.
std::string without_ranges(std::string_view head);

}  // namespace afterglow
