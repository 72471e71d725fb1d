#include "service/http/request_head.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

namespace afterglow {

namespace {

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

bool is_token(std::string_view text) {
    constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
    return !text.empty() && std::all_of(text.begin(), text.end(), [&](unsigned char c) {
        return (c < 128 && std::isalnum(c) != 0) || marks.find(static_cast<char>(c)) != marks.npos;
    });
}

bool has_control(std::string_view text) {
    return std::any_of(text.begin(), text.end(),
                       [](unsigned char c) { return (c < 32 && c != '\t') || c == 127; });
}

Problem malformed(std::string detail) {
    return {400, "malformed_request", std::move(detail), ""};
}

/// The next line without its CRLF; nothing where it does not end with one.
std::optional<std::string_view> take_line(std::string_view& rest) {
    const auto end = rest.find("\r\n");
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 2);
    return line;
}

std::optional<Problem> problem_of_request_line(std::string_view line, const HeadLimits& limits,
                                               bool& is_version_1_0) {
    if (line.size() > limits.target_bytes)
        return Problem{414, "target_too_long", "the address is too long", ""};
    const auto first = line.find(' ');
    const auto last = line.rfind(' ');
    if (first == std::string_view::npos || first == last || has_control(line))
        return malformed("the request line is not METHOD TARGET VERSION");
    const std::string_view target = line.substr(first + 1, last - first - 1);
    const std::string_view version = line.substr(last + 1);
    if (!is_token(line.substr(0, first)) || target.empty() || target.find(' ') != std::string_view::npos)
        return malformed("the request line is not METHOD TARGET VERSION");
    if (target.front() != '/' && target != "*") return malformed("the target must begin with a slash");
    if (!version.starts_with("HTTP/")) return malformed("the request line is not METHOD TARGET VERSION");
    is_version_1_0 = version == "HTTP/1.0";
    if (!is_version_1_0 && version != "HTTP/1.1")
        return Problem{505, "version_not_supported", "expected HTTP/1.1 or HTTP/1.0", ""};
    return std::nullopt;
}

/// What the fields say about the body and the host, gathered while they are read.
struct Framing {
    int hosts = 0;
    int lengths = 0;
    int codings = 0;
};

std::optional<Problem> problem_of_length(std::string_view value, const HeadLimits& limits) {
    const bool is_number = !value.empty() && std::all_of(value.begin(), value.end(), [](unsigned char c) {
        return c >= '0' && c <= '9';
    });
    if (!is_number) return malformed("Content-Length is no number");
    std::uint64_t bytes = 0;
    for (const char digit : value) {
        bytes = bytes * 10 + static_cast<std::uint64_t>(digit - '0');
        if (bytes > limits.body_bytes)
            return Problem{413, "too_large",
                           "the body is longer than " + std::to_string(limits.body_bytes) + " bytes", "body"};
    }
    return std::nullopt;
}

std::optional<Problem> problem_of_field(std::string_view line, const HeadLimits& limits, Framing& framing) {
    if (line.size() > limits.field_bytes)
        return Problem{431, "headers_too_large", "a header field is too long", ""};
    const auto colon = line.find(':');
    // A name that ends with a blank, and a line that continues the one before, are read differently by
    // different programs.
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon)) || has_control(line))
        return malformed("a header field is not NAME: VALUE");
    const std::string name = lower(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name == "host") ++framing.hosts;
    if (name == "content-length") {
        ++framing.lengths;
        return problem_of_length(value, limits);
    }
    if (name == "transfer-encoding") {
        ++framing.codings;
        if (lower(value) != "chunked")
            return Problem{501, "transfer_encoding_not_supported", "the only transfer coding is chunked",
                           name};
    }
    if (name == "content-encoding" && lower(value) != "identity")
        return Problem{415, "content_encoding_not_supported", "bodies are taken as they are, not compressed",
                       "Content-Encoding"};
    if (name == "expect" && lower(value) != "100-continue")
        return Problem{417, "expectation_failed", "the only expectation is 100-continue", "Expect"};
    return std::nullopt;
}

std::optional<Problem> problem_of_framing(const Framing& framing, bool is_version_1_0) {
    if (framing.hosts > 1 || (framing.hosts == 0 && !is_version_1_0))
        return malformed("exactly one Host field is needed");
    if (framing.lengths > 1) return malformed("Content-Length is given more than once");
    if (framing.codings > 1) return malformed("Transfer-Encoding is given more than once");
    if (framing.codings > 0 && (framing.lengths > 0 || is_version_1_0))
        return malformed("Transfer-Encoding and Content-Length contradict each other");
    return std::nullopt;
}

}  // namespace

std::optional<std::size_t> head_length(std::string_view received) {
    for (auto at = received.find('\n'); at != std::string_view::npos; at = received.find('\n', at + 1)) {
        if (received.substr(at + 1).starts_with("\r\n")) return at + 3;
        if (received.substr(at + 1).starts_with("\n")) return at + 2;
    }
    return std::nullopt;
}

std::optional<Problem> problem_of_head(std::string_view head, const HeadLimits& limits) {
    bool is_version_1_0 = false;
    std::string_view rest = head;
    const auto first = take_line(rest);
    if (!first) return malformed("lines must end with CR LF");
    if (auto problem = problem_of_request_line(*first, limits, is_version_1_0)) return problem;
    if (head.size() > limits.bytes) return Problem{431, "headers_too_large", "the header is too long", ""};
    Framing framing;
    for (std::size_t fields = 0;; ++fields) {
        const auto line = take_line(rest);
        if (!line) return malformed("lines must end with CR LF");
        if (line->empty()) break;
        if (fields == limits.fields)
            return Problem{431, "headers_too_large", "there are too many header fields", ""};
        if (auto problem = problem_of_field(*line, limits, framing)) return problem;
    }
    return problem_of_framing(framing, is_version_1_0);
}

bool is_chunked(std::string_view head) {
    while (const auto line = take_line(head))
        if (lower(line->substr(0, line->find(':'))) == "transfer-encoding") return true;
    return false;
}

std::string without_ranges(std::string_view head) {
    std::string out;
    while (const auto line = take_line(head)) {
        const std::string name = lower(line->substr(0, line->find(':')));
        if (name == "range" || name == "if-range") continue;
        out += *line;
        out += "\r\n";
    }
    return out;
}

}  // namespace afterglow
