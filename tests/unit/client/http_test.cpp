#include "client/http.h"

#include <gtest/gtest.h>

#include "client/error.h"

namespace afterglow::client {
namespace {

TEST(ServerUrl, TakesSchemeHostAndPort) {
    EXPECT_EQ(parse_server_url("http://localhost:8080"), "http://localhost:8080");
    EXPECT_EQ(parse_server_url("http://localhost:8080/"), "http://localhost:8080");
    EXPECT_EQ(parse_server_url("https://render.example.org"), "https://render.example.org");
    EXPECT_EQ(parse_server_url("127.0.0.1:99"), "http://127.0.0.1:99");
    EXPECT_EQ(parse_server_url("http://[::1]:8080"), "http://[::1]:8080");
}

TEST(ServerUrl, RefusesTheRest) {
    for (const char* bad :
         {"", "http://", "ftp://a", "http://a:0", "http://a:65536", "http://a:", "http://a:x", "http://a/b",
          "http://a?b", "http://u@a", "http://a b", "http://:80"}) {
        try {
            parse_server_url(bad);
            ADD_FAILURE() << "accepted " << bad;
        } catch (const ClientError& error) {
            EXPECT_EQ(error.code(), ExitCode::bad_input) << bad;
        }
    }
}

TEST(HttpReply, FindsHeadersWithoutRegardToCase) {
    const HttpReply reply{200, {{"Content-Type", "a"}, {"ETag", "b"}}, ""};
    EXPECT_EQ(reply.header("content-type"), "a");
    EXPECT_EQ(reply.header("etag"), "b");
    EXPECT_EQ(reply.header("etags"), "");
}

TEST(HttpConnection, ReportsAServerThatIsNotThere) {
    Interrupt interrupt;
    HttpConnection connection("http://127.0.0.1:1", interrupt);  // port 1 (tcpmux) has no listener
    try {
        connection.get("/healthz");
        ADD_FAILURE() << "a server answered";
    } catch (const ClientError& error) {
        EXPECT_EQ(error.code(), ExitCode::no_server);
        EXPECT_STREQ(error.what(), "http://127.0.0.1:1: cannot be reached");
    }
}

}  // namespace
}  // namespace afterglow::client
