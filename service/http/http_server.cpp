#include "service/http/http_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>
#include <utility>

#include <httplib.h>

#include "service/base/console.h"
#include "service/http/guarded_server.h"
#include "service/http/http_message.h"
#include "solver/base/error.h"

namespace afterglow {

namespace {

// What open streams get at a stop to send their last piece; they are cut off then.
constexpr std::chrono::seconds stop_grace{2};

// What chunks and boundaries may add to a body.
constexpr std::size_t framing_bytes = std::size_t{1} << 20U;

bool has_body(const httplib::Request& request) {
    // Without either header a body has no end but the connection's, so there is none.
    return request.has_header("Content-Length") || request.has_header("Transfer-Encoding");
}

bool is_method_with_body(const std::string& method) {
    return method == "POST" || method == "PUT" || method == "PATCH" || method == "DELETE";
}

Request to_request(const httplib::Request& from) {
    Request request;
    request.method = from.method;
    request.path = from.path;
    for (const auto& [name, value] : from.params) request.query.emplace(name, value);
    for (const auto& [name, value] : from.headers) {
        std::string lower = name;
        std::transform(lower.begin(), lower.end(), lower.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        request.headers.emplace(std::move(lower), value);
    }
    return request;
}

/// Held by every open stream, so that its users are the open streams.
using StreamToken = std::shared_ptr<const char>;

httplib::ContentProviderWithoutLength provider_of(std::shared_ptr<ReplyStream> stream, StreamToken token) {
    return [stream = std::move(stream), token = std::move(token)](std::size_t, httplib::DataSink& sink) {
        try {
            if (!sink.is_writable()) return false;
            const Piece piece = stream->next();
            if (!piece.bytes.empty() && !sink.write(piece.bytes.data(), piece.bytes.size())) return false;
            if (piece.then == Piece::Then::end) sink.done();
            return true;
        } catch (...) {
            return false;  // the connection ends, which tells the reader
        }
    };
}

/// Nothing that is sent here may be framed, guessed at or mixed with other sites' content.
constexpr std::array<std::pair<const char*, const char*>, 4> careful_headers{{
    {"Content-Security-Policy",
     "default-src 'none'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
}};

void send(Reply reply, const StreamToken& token, httplib::Response& to) {
    to.status = reply.status;
    for (const auto& [name, value] : reply.headers) to.set_header(name, value);
    for (const auto& [name, value] : careful_headers)
        if (!to.has_header(name)) to.set_header(name, value);
    if (reply.stream) {
        to.set_chunked_content_provider(reply.content_type, provider_of(std::move(reply.stream), token));
        return;
    }
    if (!reply.content_type.empty()) to.set_header("Content-Type", reply.content_type);
    to.body = std::move(reply.body);
}

std::string code_of_status(int status) {
    return status == 413 ? "too_large" : status == 415 ? "unsupported_media_type" : "bad_request";
}

Reply too_many_streams() {
    Reply reply = problem_reply({503, "too_many_streams", "too many streams are open; try again", ""});
    reply.headers.emplace_back("Retry-After", "5");
    return reply;
}

/// A body received in parts, up to a limit. Past it the rest is taken and thrown away, so that the client
/// gets to read the reply; past twice the limit nothing more is taken.
class ReceivedBody {
  public:
    explicit ReceivedBody(std::size_t limit) : limit_(limit) {}

    bool take(const char* data, std::size_t size) {
        seen_ += size;
        if (seen_ <= limit_)
            bytes_.append(data, size);
        else
            bytes_ = std::string();
        return seen_ <= 2 * limit_;
    }
    [[nodiscard]] std::size_t seen() const { return seen_; }
    /// What comes next belongs to a new part of a form; its name and its start count too.
    bool begin_part(const std::string& name, const std::string& file_name) {
        end_part();
        parts_.push_back({name, file_name, {}});
        seen_ += name.size() + file_name.size() + sizeof(FormPart);
        return seen_ <= 2 * limit_;
    }
    [[nodiscard]] bool is_too_large() const { return seen_ > limit_; }
    std::string take_bytes() { return std::move(bytes_); }
    std::vector<FormPart> take_parts() {
        end_part();
        return std::move(parts_);
    }

  private:
    void end_part() {
        if (!parts_.empty()) parts_.back().body = std::exchange(bytes_, {});
    }

    std::size_t limit_;
    std::size_t seen_ = 0;
    std::string bytes_;  ///< of the part in hand, for a form
    std::vector<FormPart> parts_;
};

/// Counts who is inside, so that who reads that nobody is knows all they did. (A shared pointer's count does
/// not say that: it is read without order.)
class Inside {
  public:
    explicit Inside(std::atomic<int>& count) : count_(count) {
        count_.fetch_add(1, std::memory_order_relaxed);
    }
    ~Inside() { count_.fetch_sub(1, std::memory_order_release); }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

  private:
    std::atomic<int>& count_;
};

}  // namespace

class HttpServer::Parts {
  public:
    Parts(const Router& router, HttpServerConfig config)
        : router_(router), config_(std::move(config)), server_(guard_of(config_)) {
        server_.set_payload_max_length(config_.max_body_bytes);
        set_up_handlers();
    }
    ~Parts() { stop(); }
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;

    int start() {
        const int port = server_.bind(config_.address, config_.port);
        if (port < 0)
            throw Error(ErrorKind::io, config_.address + ":" + std::to_string(config_.port),
                        "this address cannot be listened on; another program may have it");
        listener_ = std::thread([this] {
            server_.listen_after_bind();
            has_ended_ = true;
        });
        // A stop before the listener runs would be lost.
        while (!server_.is_running() && !has_ended_)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return port;
    }

    void keep(const std::weak_ptr<void>& self) { server_.keep(self); }

    void stop() {
        if (has_stopped_.exchange(true)) return;
        const auto give_up = std::chrono::steady_clock::now() + stop_grace;
        while (token_.use_count() > 1 && std::chrono::steady_clock::now() < give_up)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        server_.stop_listening();
        if (listener_.joinable()) listener_.join();
        // Connections whose provider sleeps on keep these parts alive. Routes do not: they are waited for.
        if (!server_.end_connections(stop_grace))
            while (routing_.load(std::memory_order_acquire) > 0)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    [[nodiscard]] bool is_running() const { return server_.is_running() && !has_ended_; }

  private:
    static GuardConfig guard_of(const HttpServerConfig& config) {
        GuardConfig guard{config.max_connections, config.patience, {}};
        guard.head.body_bytes = config.max_body_bytes;
        guard.patience.body_bytes = 2 * config.max_body_bytes + framing_bytes;
        return guard;
    }

    void set_up_handlers() {
        server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            if (is_method_with_body(request.method)) return httplib::Server::HandlerResponse::Unhandled;
            answer(to_request(request), response);
            return httplib::Server::HandlerResponse::Handled;
        });
        const auto receive = [this](const httplib::Request& request, httplib::Response& response,
                                    const httplib::ContentReader& reader) {
            receive_body(request, response, reader);
        };
        server_.Post(any_path, receive);
        server_.Put(any_path, receive);
        server_.Patch(any_path, receive);
        server_.Delete(any_path, receive);
        // What the library refuses by itself is told in the same form as everything else.
        server_.set_error_handler([](const httplib::Request&, httplib::Response& response) {
            if (!response.body.empty()) return;
            const std::string detail(title_of(response.status));
            send(problem_reply({response.status, code_of_status(response.status), detail, ""}), {}, response);
        });
        server_.set_exception_handler(
            [](const httplib::Request&, httplib::Response& response, const std::exception_ptr& caught) {
                send(problem_reply(problem_of(caught)), {}, response);
            });
        if (config_.access_log == AccessLog::on)
            server_.set_logger([](const httplib::Request& request, const httplib::Response& response) {
                std::cerr << one_line(request.method + " " + request.target) + " " +
                                 std::to_string(response.status) + "\n";
            });
    }

    void answer(Request request, httplib::Response& response) const {
        const Inside routing(routing_);
        if (!is_admitted(request, response)) return;
        Reply reply = router_.handle(request);
        // Other requests must find a place however many watch.
        if (reply.stream && static_cast<std::size_t>(token_.use_count()) > config_.max_streams)
            reply = too_many_streams();
        send(std::move(reply), token_, response);
    }

    bool is_admitted(Request& request, httplib::Response& response) const {
        if (!config_.gate) return true;
        auto refusal = config_.gate(request);
        if (!refusal) return true;
        send(*std::move(refusal), {}, response);
        return false;
    }

    void receive_body(const httplib::Request& from, httplib::Response& response,
                      const httplib::ContentReader& reader) const {
        const Inside routing(routing_);
        Request request = to_request(from);
        if (!is_admitted(request, response)) return;
        if (has_body(from)) {
            // A number, or its head would have been refused.
            const std::size_t announced =
                std::strtoull(request.header("content-length").c_str(), nullptr, 10);
            if (auto refusal = check_body(request, announced)) return send(*std::move(refusal), {}, response);
            if (auto refusal = take_body(request, from, response, reader))
                return send(*std::move(refusal), {}, response);
        }
        send(router_.handle(request), token_, response);
    }

    std::optional<Reply> check_body(const Request& request, std::size_t bytes) const {
        return config_.body_check ? config_.body_check(request, bytes) : std::nullopt;
    }

    /// Receives the request's body; why not, where it cannot be had.
    std::optional<Reply> take_body(Request& request, const httplib::Request& from,
                                   const httplib::Response& response,
                                   const httplib::ContentReader& reader) const {
        ReceivedBody body(config_.max_body_bytes);
        std::optional<Reply> refusal;
        const auto take = [&](const char* data, std::size_t size) {
            if (!body.take(data, size)) return false;
            refusal = check_body(request, body.seen());
            return !refusal;
        };
        const bool is_form = from.is_multipart_form_data();
        const bool complete =
            is_form
                ? reader([&](const auto& part) { return body.begin_part(part.name, part.filename); }, take)
                : reader(take);
        if (refusal) return refusal;
        if (!complete || body.is_too_large()) {
            const int status = body.is_too_large() ? 413 : response.status >= 400 ? response.status : 400;
            return problem_reply({status, code_of_status(status), "the body could not be taken", "body"});
        }
        if (is_form)
            request.parts = body.take_parts();
        else
            request.body = body.take_bytes();
        return std::nullopt;
    }

    static constexpr const char* any_path = R"([\s\S]*)";

    const Router& router_;
    HttpServerConfig config_;
    StreamToken token_ = std::make_shared<const char>();
    mutable std::atomic<int> routing_ = 0;  ///< how many are in a route or gate
    std::atomic<bool> has_stopped_ = false;
    GuardedServer server_;
    std::thread listener_;
    std::atomic<bool> has_ended_ = false;
};

HttpServer::HttpServer(const Router& router, HttpServerConfig config)
    : parts_(std::make_shared<Parts>(router, std::move(config))) {
    parts_->keep(parts_);
}

HttpServer::~HttpServer() {
    stop();
}

int HttpServer::start() {
    return parts_->start();
}
void HttpServer::stop() {
    parts_->stop();
}
bool HttpServer::is_running() const {
    return parts_->is_running();
}

}  // namespace afterglow
