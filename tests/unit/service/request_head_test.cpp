#include "service/http/request_head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

int status(const std::string& head) {
    const auto problem = problem_of_head(head, {});
    return problem ? problem->status : 200;
}

TEST(RequestHead, EndsWithAnEmptyLine) {
    EXPECT_EQ(head_length("GET / HTTP/1.1\r\n"), std::nullopt);
    EXPECT_EQ(head_length("GET / HTTP/1.1\r\n\r\nbody"), 18U);
    EXPECT_EQ(head_length("GET / HTTP/1.1\n\nbody"), 16U);
    EXPECT_EQ(head_length(""), std::nullopt);
}

TEST(RequestHead, WhatClientsSendIsTaken) {
    EXPECT_EQ(status("GET /v1/jobs?state=running HTTP/1.1\r\nHost: localhost:8080\r\nAccept: */*\r\n\r\n"),
              200);
    EXPECT_EQ(status("POST /x HTTP/1.1\r\nhost:x\r\nContent-Length:  12 \r\nExpect: 100-continue\r\n\r\n"),
              200);
    EXPECT_EQ(status("GET / HTTP/1.0\r\n\r\n"), 200);
}

TEST(RequestHead, WhatIsMalformedIsRefused) {
    for (const char* head :
         {"", "\r\n", "nonsense\r\n\r\n", "GET /\r\n\r\n", "GET  HTTP/1.1\r\nHost: x\r\n\r\n",
          "GET http://x/ HTTP/1.1\r\nHost: x\r\n\r\n", "GET /a b HTTP/1.1\r\nHost: x\r\n\r\n",
          "GET / HTTP/1.1\r\nHost: x\r\nHost: y\r\n\r\n", "GET / HTTP/1.1\r\nHost: x\r\n folded: y\r\n\r\n",
          "GET / HTTP/1.1\r\nHost: x\r\nA B: y\r\n\r\n", "GET / HTTP/1.1\r\nHost: x\r\n: y\r\n\r\n",
          "GET / HTTP/1.1\r\nHost: x\rX: y\r\n\r\n", "GET / HTTP/1.1\r\nHost: x\nContent-Length: 3\r\n\r\n",
          "GET / HTTP/1.1\r\nHost: x\r\nContent-Length: \r\n\r\n",
          "GET / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"})
        EXPECT_EQ(status(head), 400) << head;
    EXPECT_EQ(status(std::string("GET / HTTP/1.1\r\nHost: a\0b\r\n\r\n", 29)), 400);
    EXPECT_EQ(status("GET / HTTP/2.0\r\nHost: x\r\n\r\n"), 505);
    EXPECT_EQ(status("GET /" + std::string(9000, 'a') + " HTTP/1.1\r\n\r\n"), 414);
    EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(9000, 'a') + "\r\n\r\n"), 431);
}

TEST(RequestHead, RangesAreTakenOut) {
    EXPECT_EQ(without_ranges("GET / HTTP/1.1\r\nHost: x\r\nRANGE: bytes=0-1\r\nIf-Range: y\r\nA: b\r\n\r\n"),
              "GET / HTTP/1.1\r\nHost: x\r\nA: b\r\n\r\n");
}

}  // namespace
}  // namespace afterglow
