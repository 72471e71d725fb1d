#include <atomic>
#include <chrono>
#include <fcntl.h>
#include <memory>
#include <poll.h>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/http/guarded_server.h"
#include "service/http/http_server.h"
#include "solver/base/error.h"
#include "tests/unit/service/peer.h"

// What a hostile or unlucky peer does to the library as it is shipped, and must not do here.

namespace afterglow {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A stream that says nothing until it is told to end; `next` waits as long as it is told.
class SilentStream : public ReplyStream {
  public:
    explicit SilentStream(milliseconds wait) : wait_(wait) {}
    Piece next() override {
        std::this_thread::sleep_for(wait_);
        return {};
    }

  private:
    milliseconds wait_;
};

class Hardening : public testing::Test {
  protected:
    Hardening() {
        router_.add("GET", "/hello", [](const Request&, const PathValues&) {
            return json_reply({{"hello", "world"}});
        });
        router_.add("POST", "/echo", [](const Request& request, const PathValues&) {
            return Reply{200, "text/plain", request.body, {}, nullptr};
        });
        add_stream("/stream", milliseconds(100));
        add_stream("/asleep", milliseconds(20'000));
    }
    void add_stream(const std::string& path, milliseconds wait) {
        router_.add("GET", path, [wait](const Request&, const PathValues&) {
            return Reply{200, "text/event-stream", "", {}, std::make_shared<SilentStream>(wait)};
        });
    }
    void start() {
        server_ = std::make_unique<HttpServer>(router_, config_);
        port_ = server_->start();
    }
    std::string exchange(const std::string& bytes) const {
        const Peer peer(port_);
        peer.send(bytes);
        return peer.receive_all();
    }
    std::string get(const std::string& path, const std::string& fields = "") const {
        return exchange("GET " + path + " HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n");
    }
    std::string post(const std::string& fields, const std::string& body) const {
        return exchange("POST /echo HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n" + body);
    }
    std::vector<std::unique_ptr<Peer>> open(std::size_t count, const std::string& path) const {
        std::vector<std::unique_ptr<Peer>> peers;
        for (std::size_t i = 0; i < count; ++i) {
            peers.push_back(std::make_unique<Peer>(port_));
            peers.back()->send("GET " + path + " HTTP/1.1\r\nHost: x\r\n\r\n");
            EXPECT_THAT(peers.back()->receive_until("\r\n\r\n"), StartsWith("HTTP/1.1 200"));
        }
        return peers;
    }

    Router router_;
    HttpServerConfig config_;
    std::unique_ptr<HttpServer> server_;
    int port_ = 0;
};

TEST_F(Hardening, OneHundredAndTwentyEightStreamsHoldNobodyElseUp) {
    start();
    const auto streams = open(128, "/stream");
    EXPECT_THAT(get("/hello"), HasSubstr("world"));
}

TEST_F(Hardening, StreamsLeaveRoomForOtherRequests) {
    config_.max_streams = 4;
    start();
    const auto streams = open(4, "/stream");
    const std::string fifth = get("/stream");
    EXPECT_THAT(fifth, StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(fifth, HasSubstr("Retry-After:"));
    EXPECT_THAT(get("/hello"), HasSubstr("world"));
}

TEST_F(Hardening, ConnectionsPastTheirNumberAreToldSo) {
    config_.max_connections = 4;
    start();
    auto streams = open(4, "/stream");
    const std::string refused = get("/hello");
    EXPECT_THAT(refused, StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(refused, HasSubstr("Retry-After:"));
    EXPECT_THAT(refused, HasSubstr("too_many_connections"));
    streams.clear();
    EXPECT_THAT(get("/hello"), HasSubstr("world"));
}

TEST_F(Hardening, ChunksMayNotHaveExtensionsWithoutEnd) {
    start();
    EXPECT_THAT(post("Transfer-Encoding: chunked\r\n", "3;a=b\r\nabc\r\n0\r\n\r\n"), EndsWith("abc"));
    for (const std::string& body :
         {"3;" + std::string(100'000, 'x') + "\r\nabc\r\n0\r\n\r\n",
          "3\r\nabc\r\n0\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n", std::string("zz\r\nabc\r\n")})
        EXPECT_THAT(post("Transfer-Encoding: chunked\r\n", body), StartsWith("HTTP/1.1 400"));
}

TEST_F(Hardening, ABodyIsJudgedBeforeItComesAndWhileItDoes) {
    std::atomic<std::size_t> most = 0;
    config_.body_check = [&](const Request& request, std::size_t bytes) -> std::optional<Reply> {
        most = std::max(most.load(), bytes);
        if (bytes <= 1000) return std::nullopt;
        return problem_reply({429, "quota_exceeded", "too much for " + request.path, "bytes"});
    };
    start();
    EXPECT_THAT(post("Content-Length: 3\r\n", "abc"), EndsWith("abc"));
    EXPECT_THAT(post("Content-Length: 1001\r\n", ""), HasSubstr("too much for /echo")) << "nothing was sent";
    most = 0;
    std::string endless;
    for (int i = 0; i < 10'000; ++i) endless += "64\r\n" + std::string(100, 'x') + "\r\n";
    EXPECT_THAT(post("Transfer-Encoding: chunked\r\n", endless), StartsWith("HTTP/1.1 429"));
    EXPECT_LT(most, 20'000U) << "the rest was not received";
}

TEST_F(Hardening, AHeadThatDripsIsGivenUp) {
    config_.patience.head = milliseconds(300);
    start();
    const Peer peer(port_);
    const auto began = steady_clock::now();
    // Each byte comes well within any time limit for a single read.
    std::thread dripping([&] {
        const std::string head = "GET /hello HTTP/1.1\r\nX-Slow: " + std::string(100'000, 'x');
        for (const char c : head) {
            if (!peer.send(std::string(1, c)) || steady_clock::now() - began > std::chrono::seconds(20))
                break;
            std::this_thread::sleep_for(milliseconds(20));
        }
    });
    EXPECT_THAT(peer.receive_all(), StartsWith("HTTP/1.1 408"));
    dripping.join();
    EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(20));
}

TEST_F(Hardening, ABodyThatDripsIsGivenUp) {
    config_.patience.body_start = milliseconds(300);
    start();
    const Peer peer(port_);
    peer.send("POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 1000\r\n\r\nabc");
    EXPECT_THAT(peer.receive_all(), StartsWith("HTTP/1.1 4"));
}

TEST_F(Hardening, TwentyThousandFieldsAreRefused) {
    start();
    std::string fields;
    for (int i = 0; i < 20'000; ++i) fields += "X-" + std::to_string(i) + ": y\r\n";
    EXPECT_THAT(get("/hello", fields), StartsWith("HTTP/1.1 431"));
    fields.clear();
    for (int i = 0; i < 150; ++i) fields += "a:b\r\n";
    EXPECT_THAT(get("/hello", fields), StartsWith("HTTP/1.1 431"));
}

TEST_F(Hardening, ManyOverlappingRangesInflateNothing) {
    start();
    std::string ranges = "Range: bytes=0-1";
    for (int i = 0; i < 1'500; ++i) ranges += ",0-";
    const std::string reply = get("/hello", ranges + "\r\n");
    EXPECT_THAT(reply, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(reply, EndsWith("\r\n\r\n{\"hello\":\"world\"}\n"));
}

TEST_F(Hardening, FramingThatContradictsItselfIsRefused) {
    start();
    EXPECT_THAT(post("Content-Length: 3\r\n", "abc"), EndsWith("abc"));
    EXPECT_THAT(post("Content-Length: 3\r\nContent-Length: 3\r\n", "abc"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(post("Content-Length: 3\r\nContent-Length: 5\r\n", "abcde"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(post("Content-Length: 3\r\nTransfer-Encoding: chunked\r\n", "0\r\n\r\n"),
                StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(post("Content-Length: +3\r\n", "abc"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(post("Content-Length : 3\r\n", "abc"), StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(post("Transfer-Encoding: gzip, chunked\r\n", "0\r\n\r\n"), StartsWith("HTTP/1.1 501"));
    EXPECT_THAT(exchange("GET /hello HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 400")) << "no Host";
    EXPECT_THAT(exchange("GET /hello HTTP/1.1\nHost: x\n\n"), StartsWith("HTTP/1.1 400"));
}

TEST_F(Hardening, CompressedBodiesAreRefusedUnread) {
    start();
    EXPECT_THAT(post("Content-Encoding: gzip\r\nContent-Length: 50000\r\n", ""), StartsWith("HTTP/1.1 415"));
}

TEST_F(Hardening, ABodyAnnouncedTooLargeIsRefusedUnread) {
    config_.max_body_bytes = 1'000;
    start();
    EXPECT_THAT(post("Content-Length: 1001\r\n", ""), StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(post("Content-Length: 18446744073709551617\r\n", ""), StartsWith("HTTP/1.1 413"));
    EXPECT_THAT(post("Content-Length: 1000\r\n", std::string(1'000, 'x')), StartsWith("HTTP/1.1 200"));
}

TEST_F(Hardening, AConnectionCarriesOneRequest) {
    start();
    const std::string request = "GET /hello HTTP/1.1\r\nHost: x\r\n\r\n";
    const std::string replies = exchange(request + request);
    EXPECT_THAT(replies, HasSubstr("Connection: close"));
    EXPECT_EQ(replies.find("HTTP/1.1", 1), std::string::npos);
}

TEST_F(Hardening, AStopDoesNotWaitForAProviderThatSleeps) {
    start();
    const auto streams = open(2, "/asleep");
    const auto began = steady_clock::now();
    server_->stop();
    EXPECT_FALSE(server_->is_running());
    server_.reset();
    EXPECT_LT(steady_clock::now() - began, std::chrono::seconds(15)) << "the provider sleeps for 20 s";
    std::this_thread::sleep_until(began + std::chrono::seconds(21));  // it wakes up and harms nobody
}

TEST_F(Hardening, ARequestIsRefusedByTheGateBeforeItsBodyIsRead) {
    config_.gate = [](Request& request) -> std::optional<Reply> {
        if (request.header("x-pass") == "yes") return std::nullopt;
        return problem_reply({403, "forbidden", "no", ""});
    };
    start();
    EXPECT_THAT(post("Content-Length: 3000\r\n", ""), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(post("X-Pass: yes\r\nContent-Length: 3\r\n", "abc"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(get("/hello"), StartsWith("HTTP/1.1 403"));
}

TEST_F(Hardening, EveryReplyForbidsWhatPagesCouldDoWithIt) {
    start();
    for (const char* path : {"/hello", "/nowhere"}) {
        EXPECT_THAT(get(path), HasSubstr("Content-Security-Policy: default-src 'none'"));
        EXPECT_THAT(get(path), HasSubstr("X-Content-Type-Options: nosniff"));
    }
}

TEST(GuardedServer, ListensWithABacklogForBursts) {
    GuardedServer server({});
    const int port = server.bind("127.0.0.1", 0);
    ASSERT_GT(port, 0);
    // Nobody accepts: what completes its handshake waits in the backlog.
    std::vector<int> sockets;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int connected = 0;
    for (int i = 0; i < 200; ++i) {
        sockets.push_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        ::connect(sockets.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
        pollfd entry{sockets.back(), POLLOUT, 0};
        if (::poll(&entry, 1, 500) != 1) break;
        ++connected;
    }
    for (const int socket : sockets) ::close(socket);
    EXPECT_EQ(connected, 200);
}

}  // namespace
}  // namespace afterglow
