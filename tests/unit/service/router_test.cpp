#include "service/http/router.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

Reply ask(const Router& router, const std::string& method, const std::string& path) {
    Request request;
    request.method = method;
    request.path = path;
    return router.handle(request);
}

Router sample() {
    Router router;
    router.add("GET", "/v1/jobs/{}/frames/{}", [](const Request&, const PathValues& values) {
        return json_reply({{"job", values[0]}, {"frame", values[1]}});
    });
    router.add("GET", "/v1/jobs", [](const Request&, const PathValues&) { return json_reply("list"); });
    router.add("POST", "/v1/jobs", [](const Request&, const PathValues&) { return json_reply("made", 201); });
    router.add("GET", "/broken",
               [](const Request&, const PathValues&) -> Reply { throw std::runtime_error("inside"); });
    return router;
}

TEST(Router, FindsTheRouteAndItsValues) {
    const Reply reply = ask(sample(), "GET", "/v1/jobs/abc/frames/12");
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, "{\"job\":\"abc\",\"frame\":\"12\"}\n");
    EXPECT_EQ(ask(sample(), "POST", "/v1/jobs").status, 201);
    EXPECT_EQ(ask(sample(), "HEAD", "/v1/jobs").status, 200);
}

TEST(Router, WhateverIsNoRouteIsNotFound) {
    for (const char* path : {"", "/", "/v1", "/v1/jobs/", "/v1/jobs/a/frames/1/more", "//v1/jobs",
                             "/v1/jobs/a/../b", "x", "/v1/jobs/a/frames"})
        EXPECT_EQ(ask(sample(), "GET", path).status, 404) << path;
}

TEST(Router, OtherMethodsAreToldWhatIsAllowed) {
    const Reply reply = ask(sample(), "DELETE", "/v1/jobs");
    EXPECT_EQ(reply.status, 405);
    EXPECT_EQ(reply.content_type, "application/problem+json");
    EXPECT_THAT(reply.headers, testing::Contains(testing::Pair("Allow", "GET, HEAD, POST")));
}

TEST(Router, AThrowingHandlerBecomesAProblem) {
    testing::internal::CaptureStderr();
    const Reply reply = ask(sample(), "GET", "/broken");
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(reply.status, 500);
    EXPECT_THAT(reply.body, testing::Not(testing::HasSubstr("inside")));
}

}  // namespace
}  // namespace afterglow
