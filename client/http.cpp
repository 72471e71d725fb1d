#include "client/http.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <exception>

#include <httplib.h>

#include "client/error.h"
#include "client/text.h"

namespace afterglow::client {

namespace {

bool same_name(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    });
}

httplib::Headers library_headers(const HttpHeaders& headers) {
    return {headers.begin(), headers.end()};
}

HttpReply reply_of(const httplib::Response& response) {
    HttpReply reply{response.status, {response.headers.begin(), response.headers.end()}, response.body};
    return reply;
}

std::string reason(httplib::Error error) {
    switch (error) {
        case httplib::Error::Connection:
            return "cannot be reached";
        case httplib::Error::ConnectionTimeout:
            return "cannot be reached (timed out)";
        case httplib::Error::Read:
            return "does not reply or broke off its reply";
        case httplib::Error::Write:
            return "does not take the request";
        case httplib::Error::SSLConnection:
            return "cannot be reached securely";
        case httplib::Error::SSLServerVerification:
            return "has a certificate that is not trusted here (SSL_CERT_FILE names further ones)";
        default:
            return "cannot be used (" + httplib::to_string(error) + ")";
    }
}

void check_port(std::string_view port, const std::string& place) {
    int number = 0;
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error != std::errc() || end != port.data() + port.size() || number < 1 || number > 65535)
        throw ClientError(ExitCode::bad_input, place, "has no port from 1 to 65535 after the colon");
}

}  // namespace

std::string parse_server_url(std::string_view text) {
    const std::string place = "server " + one_line(text);
    std::string scheme = "http";
    if (const auto mark = text.find("://"); mark != std::string_view::npos) {
        scheme = text.substr(0, mark);
        text.remove_prefix(mark + 3);
    }
    if (scheme != "http" && scheme != "https")
        throw ClientError(ExitCode::bad_input, place, "is neither http:// nor https://");
    if (text.ends_with('/')) text.remove_suffix(1);
    if (text.find_first_of("/?#@ ") != std::string_view::npos)
        throw ClientError(ExitCode::bad_input, place, "must be only scheme, host and port");
    // The colons of an IPv6 address stand inside its brackets.
    const auto bracket = text.rfind(']');
    const auto colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
    if (text.substr(0, colon).empty()) throw ClientError(ExitCode::bad_input, place, "names no host");
    if (colon != std::string_view::npos) check_port(text.substr(colon + 1), place);
    return scheme + "://" + std::string(text);
}

std::string HttpReply::header(std::string_view name) const {
    const auto found = std::find_if(headers.begin(), headers.end(),
                                    [&](const auto& header) { return same_name(header.first, name); });
    return found == headers.end() ? "" : found->second;
}

struct HttpConnection::Library {
    explicit Library(const std::string& server) : client(server) {}
    httplib::Client client;

    static HttpReply take(const httplib::Result& result, const HttpConnection& connection) {
        if (result) return reply_of(*result);
        connection.interrupt_.check();
        throw ClientError(ExitCode::no_server, connection.server_, reason(result.error()));
    }
};

HttpConnection::HttpConnection(std::string server, Interrupt& interrupt, HttpConfig config)
    : server_(std::move(server)),
      interrupt_(interrupt),
      config_(config),
      library_(std::make_unique<Library>(server_)) {
    auto& client = library_->client;
    if (!client.is_valid())
        throw ClientError(ExitCode::bad_input, "server " + server_, "is not a server's URL");
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_connection_timeout(config_.connect);
    client.set_write_timeout(config_.upload);
    client.set_read_timeout(config_.reply);
    if (!config_.token.empty()) client.set_bearer_token_auth(config_.token.c_str());
    interrupt_.set_action(this, [this] { library_->client.stop(); });
}

HttpConnection::~HttpConnection() {
    interrupt_.set_action(this, {});
}

HttpReply HttpConnection::get(const std::string& path, const HttpHeaders& headers) {
    interrupt_.check();
    return Library::take(library_->client.Get(path, library_headers(headers)), *this);
}

HttpReply HttpConnection::head(const std::string& path) {
    interrupt_.check();
    return Library::take(library_->client.Head(path), *this);
}

HttpReply HttpConnection::post(const std::string& path, std::string_view body,
                               const std::string& content_type, const HttpHeaders& headers) {
    interrupt_.check();
    return Library::take(
        library_->client.Post(path, library_headers(headers), body.data(), body.size(), content_type), *this);
}

HttpReply HttpConnection::put(const std::string& path, std::string_view body,
                              const std::string& content_type) {
    interrupt_.check();
    return Library::take(library_->client.Put(path, body.data(), body.size(), content_type), *this);
}

HttpReply HttpConnection::patch(const std::string& path, std::string_view body,
                                const std::string& content_type) {
    interrupt_.check();
    return Library::take(library_->client.Patch(path, body.data(), body.size(), content_type), *this);
}

HttpReply HttpConnection::remove(const std::string& path) {
    interrupt_.check();
    return Library::take(library_->client.Delete(path), *this);
}

HttpReply HttpConnection::stream(const std::string& path, const HttpHeaders& headers,
                                 const StreamSink& sink) {
    interrupt_.check();
    HttpReply reply;
    const auto on_headers = [&](const httplib::Response& response) {
        reply = reply_of(response);
        return !interrupt_.requested();
    };
    std::exception_ptr failure;  // an exception must not pass through the library
    const auto on_bytes = [&](const char* data, std::size_t size) {
        if (interrupt_.requested()) return false;
        if (reply.status != 200) {
            reply.body.append(data, size);
            return true;
        }
        try {
            return sink({data, size}) == StreamNext::more;
        } catch (...) {
            failure = std::current_exception();
            return false;
        }
    };
    library_->client.set_read_timeout(config_.stream);
    const auto result = library_->client.Get(path, library_headers(headers), on_headers, on_bytes);
    library_->client.set_read_timeout(config_.reply);
    interrupt_.check();
    if (failure) std::rethrow_exception(failure);
    if (reply.status != 0) return reply;
    return Library::take(result, *this);
}

}  // namespace afterglow::client
