#include "client/problem.h"

#include <gtest/gtest.h>

namespace afterglow::client {
namespace {

HttpReply problem(int status, const std::string& body) {
    return {status, {{"content-type", "application/problem+json"}}, body};
}

ClientError error_for(const HttpReply& reply, NotFound not_found = NotFound::not_found) {
    return error_of(reply, "http://s", not_found);
}

TEST(Problem, BecomesOneLineOfPlaceAndDetail) {
    EXPECT_EQ(problem_line(Json::parse(R"({"title":"T","detail":"is bad","place":"request#/frames"})")),
              "request#/frames: is bad");
    EXPECT_EQ(problem_line(Json::parse(R"({"title":"T","detail":"is bad"})")), "is bad");
    EXPECT_EQ(problem_line(Json::parse(R"({"title":"T"})")), "T");
    EXPECT_EQ(problem_line(Json::parse("{}")), "no reason given");
}

TEST(Problem, DoesNotRepeatAPlaceThatTheDetailBeginsWith) {
    EXPECT_EQ(problem_line(Json::parse(R"({"detail":"a.glb: is cut off","place":"a.glb"})")),
              "a.glb: is cut off");
}

TEST(Problem, CannotSteerTheTerminal) {
    EXPECT_EQ(problem_line(Json::parse(R"({"detail":"a\nb\u001b[2J","place":"x\r"})")), "x : a b [2J");
}

TEST(Problem, ChoosesTheExitCodeByStatus) {
    const std::string body = R"({"detail":"d"})";
    EXPECT_EQ(error_for(problem(400, body)).code(), ExitCode::bad_input);
    EXPECT_EQ(error_for(problem(422, body)).code(), ExitCode::bad_input);
    EXPECT_EQ(error_for(problem(409, body)).code(), ExitCode::bad_input);
    EXPECT_EQ(error_for(problem(404, body)).code(), ExitCode::not_found);
    EXPECT_EQ(error_for(problem(404, body), NotFound::bad_input).code(), ExitCode::bad_input);
    EXPECT_EQ(error_for(problem(500, body)).code(), ExitCode::no_server);
    EXPECT_STREQ(error_for(problem(422, body)).what(), "d");
}

TEST(Problem, ARefusalWithoutAProblemObjectMeansThatItIsNotOurService) {
    const auto error = error_for({404, {{"Content-Type", "text/html"}}, "<html>"});
    EXPECT_EQ(error.code(), ExitCode::no_server);
    EXPECT_STREQ(error.what(), "http://s: replied with HTTP status 404 and no explanation");
}

TEST(JsonReply, ReturnsObjectsOnly) {
    EXPECT_EQ(json_reply({201, {}, R"({"id":"x"})"}, "s")["id"], "x");
    for (const char* body : {"[]", "", "{", "null", "<html>"})
        EXPECT_THROW(json_reply({200, {}, body}, "s"), ClientError) << body;
    EXPECT_THROW(json_reply(problem(404, "{}"), "s"), ClientError);
}

TEST(Json, RefusesDeepNestingWithoutExhaustingTheStack) {
    EXPECT_THROW(parse_json(std::string(1'000'000, '['), "s"), ClientError);
    EXPECT_NO_THROW(parse_json(std::string(60, '[') + std::string(60, ']'), "s"));
}

TEST(Json, ReadsForgivingly) {
    const Json json =
        Json::parse(R"({"s":"x","n":1.5,"i":7,"big":1e20,"huge":99999999999,"t":true,"z":null})");
    EXPECT_EQ(find_string(json, "s"), "x");
    EXPECT_EQ(find_string(json, "n"), std::nullopt);
    EXPECT_EQ(find_number(json, "n"), 1.5);
    EXPECT_EQ(find_number(json, "z"), std::nullopt);
    EXPECT_EQ(find_int(json, "i"), 7);
    EXPECT_EQ(find_int(json, "big"), std::nullopt);
    EXPECT_EQ(find_int(json, "huge"), std::nullopt);
    EXPECT_TRUE(is_true(json, "t"));
    EXPECT_FALSE(is_true(json, "i"));
    EXPECT_EQ(find_int(Json::array(), "i"), std::nullopt);
}

}  // namespace
}  // namespace afterglow::client
