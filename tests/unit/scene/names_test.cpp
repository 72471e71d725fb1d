#include "solver/scene/names.h"

#include <gmock/gmock.h>

namespace afterglow {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Named {
    std::string name;
};

std::string refusal(const Names& names, const std::string& name) {
    const Json json = name;
    try {
        static_cast<void>(names.find(JsonView(json, "doc")));
    } catch (const Error& e) {
        return e.what();
    }
    return "found";
}

TEST(EditDistance, CountsSingleLetterChanges) {
    EXPECT_EQ(edit_distance("walker", "walker"), 0);
    EXPECT_EQ(edit_distance("walker", "waker"), 1);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("abc", "axbc"), edit_distance("axbc", "abc"));
}

TEST(Names, FindsElementsByName) {
    const Names names(std::vector<Named>{{"a"}, {"b"}}, "node");
    const Json json = "b";
    EXPECT_EQ(names.find(JsonView(json, "doc")), 1U);
    EXPECT_TRUE(names.contains("a"));
    EXPECT_FALSE(names.contains("c"));
}

TEST(Names, SuggestsNearNamesFirst) {
    const Names names(std::vector<Named>{{"visitor"}, {"walker2"}, {"walkers"}, {"talker"}}, "node");
    EXPECT_THAT(refusal(names, "walker"),
                AllOf(HasSubstr("doc: there is no node \"walker\""), HasSubstr("did you mean \"walker2\""),
                      Not(HasSubstr("visitor"))));
    EXPECT_THAT(refusal(names, "qqqqq"), HasSubstr("there are \"visitor\""));
}

TEST(Names, ListsBothElementsOfAnAmbiguousName) {
    const Names names(std::vector<Named>{{"x"}, {"chair"}, {"y"}, {"chair"}, {"chair"}}, "node");
    EXPECT_THAT(refusal(names, "chair"), HasSubstr("numbers 1 and 3"));
}

TEST(Names, KeepsMessagesToOneShortLine) {
    const Names names(std::vector<Named>{{std::string(10'000, 'x') + "\n"}}, "node");
    const std::string message = refusal(names, std::string(10'000, 'y') + "\n");
    EXPECT_LT(message.size(), 300U);
    EXPECT_THAT(message, Not(HasSubstr("\n")));
}

}  // namespace
}  // namespace afterglow
