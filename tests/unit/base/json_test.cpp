#include "solver/base/json.h"

#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

/// Expects `action` to fail at `place` with a message that contains `part`.
void expect_failure(const std::function<void()>& action, const std::string& place, const std::string& part) {
    try {
        action();
        FAIL() << "no failure at " << place;
    } catch (const Error& e) {
        EXPECT_EQ(e.place(), place);
        EXPECT_THAT(e.message(), testing::HasSubstr(part));
    }
}

ErrorKind kind_of_failure(std::string_view text) {
    try {
        parse_json(text, "text");
    } catch (const Error& e) {
        return e.kind();
    }
    ADD_FAILURE() << "parsed: " << text.substr(0, 60);
    return ErrorKind::io;
}

std::string nested(std::size_t depth, char open, char close) {
    return std::string(depth, open) + std::string(depth, close);
}

TEST(ParseJson, NamesTheSourceAndTheByte) {
    expect_failure([] { parse_json("{\"a\": 1,}", "room.json"); }, "room.json", "byte 9");
    for (const char* text : {"", "{", "[1 2]", "nul", "\"\\ud800\"", "\"\xff\"", "{} {}"})
        EXPECT_EQ(kind_of_failure(text), ErrorKind::invalid_input) << text;
    EXPECT_EQ(kind_of_failure("1e999"), ErrorKind::invalid_input);
}

TEST(ParseJson, TakesSixtyFourLevelsAndNoMore) {
    EXPECT_NO_THROW(parse_json(nested(64, '[', ']'), "text"));
    EXPECT_EQ(kind_of_failure(nested(65, '[', ']')), ErrorKind::too_large);
    // Deep enough to exhaust the stack of a recursive parser, closed or not.
    EXPECT_EQ(kind_of_failure(nested(200000, '[', ']')), ErrorKind::too_large);
    EXPECT_EQ(kind_of_failure(std::string(200000, '[')), ErrorKind::too_large);
    std::string objects;
    for (int i = 0; i < 200000; ++i) objects += "{\"a\":";
    EXPECT_EQ(kind_of_failure(objects), ErrorKind::too_large);
}

TEST(ParseJson, BracketsInsideStringsDoNotNest) {
    const std::string text = "[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]";
    EXPECT_EQ(JsonView(parse_json(text, "text"), "text").value().at(0).get<std::string>().size(), 2001U);
}

class JsonViewTest : public testing::Test {
  protected:
    Json document_ = parse_json(R"({"name": "wall", "size": [1, 2.5, -3], "on": true, "count": 7,
        "a/b": {"~": 1e40}, "none": null, "list": []})",
                                "room.json");
    JsonView view_{document_, "room.json"};
};

TEST_F(JsonViewTest, ReadsWhatIsThere) {
    EXPECT_EQ(view_.at("name").as_string(), "wall");
    EXPECT_TRUE(view_.at("on").as_bool());
    EXPECT_EQ(view_.at("count").as_integer_in(0, 7), 7);
    EXPECT_EQ(view_.at("size").as_vec3(), Vec3(1, 2.5F, -3));
    EXPECT_EQ(view_.at("count").as_index(8), 7U);
    EXPECT_FALSE(view_.find("nothing"));
    EXPECT_TRUE(view_.at("list").elements().empty());
    std::string keys;
    for (const auto& [key, member] : view_.members()) keys += key + " ";
    EXPECT_EQ(keys, "name size on count a/b none list ");
}

TEST_F(JsonViewTest, PlacesAreEscapedPointers) {
    EXPECT_EQ(view_.place(), "room.json");
    EXPECT_EQ(view_.at("size").elements()[2].place(), "room.json#/size/2");
    EXPECT_EQ(view_.at("a/b").at("~").pointer(), "/a~1b/~0");
}

TEST_F(JsonViewTest, FailuresNameTheFieldAndWhatWasFound) {
    expect_failure([&] { (void)view_.at("width"); }, "room.json", "\"width\"");
    expect_failure([&] { (void)view_.at("name").at("x"); }, "room.json#/name", "expected an object");
    expect_failure([&] { (void)view_.at("size").as_string(); }, "room.json#/size", "found array");
    expect_failure([&] { (void)view_.at("name").as_number(); }, "room.json#/name", "\"wall\"");
    expect_failure([&] { (void)view_.at("none").as_bool(); }, "room.json#/none", "null");
    expect_failure([&] { (void)view_.at("size").as_numbers(2); }, "room.json#/size", "expected 2 numbers");
    expect_failure([&] { (void)view_.at("count").elements(); }, "room.json#/count", "expected an array");
    expect_failure([&] { view_.allow_only({"name"}); }, "room.json#/size", "unknown field");
}

TEST_F(JsonViewTest, NumbersStayInRange) {
    const JsonView count = view_.at("count");
    expect_failure([&] { (void)count.as_number_in(7.5, 9); }, "room.json#/count", "7.5");
    expect_failure([&] { (void)count.as_index(7); }, "room.json#/count", "whole number");
    expect_failure([&] { (void)count.as_index(0); }, "room.json#/count", "empty list");
    const JsonView fraction = view_.at("size").elements()[1];
    expect_failure([&] { (void)fraction.as_integer_in(0, 9); }, "room.json#/size/1", "whole number");
    // Neither a conversion to an integer nor to single precision may wrap or overflow in silence.
    const JsonView huge = view_.at("a/b").at("~");
    expect_failure([&] { (void)huge.as_integer_in(0, 9); }, "room.json#/a~1b/~0", "whole number");
    const Json vector = parse_json("[0, 0, 1e40]", "v");
    expect_failure([&] { (void)JsonView(vector, "v").as_vec3(); }, "v", "single precision");
}

TEST(ParseJson, ObjectsWithVeryManyMembersAreRefused) {
    const auto object_of = [](int members) {
        std::string text = "{";
        for (int k = 0; k < members; ++k) text += (k > 0 ? ",\"k" : "\"k") + std::to_string(k) + "\":[{}]";
        return text + "}";
    };
    EXPECT_EQ(parse_json(object_of(4096), "test").size(), 4096U);
    try {
        parse_json(object_of(4097), "test");
        FAIL() << "must throw";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::too_large);
    }
}

}  // namespace
}  // namespace afterglow
