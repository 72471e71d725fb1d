#include "service/base/problem.h"

#include <new>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace afterglow {
namespace {

using testing::HasSubstr;
using testing::Not;

Problem caught(auto thrown) {
    try {
        throw thrown;
    } catch (...) {
        return problem_of(std::current_exception());
    }
}

TEST(Problem, UnusableInputKeepsItsPlace) {
    const Problem problem =
        problem_of(Error(ErrorKind::invalid_input, "request#/settings/width", "too wide"));
    EXPECT_EQ(problem.status, 422);
    EXPECT_EQ(problem.code, "invalid_input");
    EXPECT_EQ(problem.place, "request#/settings/width");
    EXPECT_EQ(problem.detail, "too wide");
    EXPECT_EQ(problem_of(Error(ErrorKind::too_large, "", "")).status, 413);
    EXPECT_EQ(problem_of(Error(ErrorKind::cannot_converge, "", "")).status, 422);
}

TEST(Problem, FailuresOfOurOwnSayNothingOfTheInside) {
    testing::internal::CaptureStderr();
    const Problem disk = problem_of(Error(ErrorKind::io, "/secret/path", "disk full"));
    const Problem defect = caught(std::logic_error("secret state"));
    const std::string told = testing::internal::GetCapturedStderr();
    for (const Problem& problem : {disk, defect}) {
        EXPECT_EQ(problem.status, 500);
        EXPECT_THAT(to_json(problem).dump(), Not(HasSubstr("secret")));
    }
    EXPECT_THAT(told, HasSubstr("/secret/path"));
    EXPECT_THAT(told, HasSubstr("secret state"));
}

TEST(Problem, WhateverIsThrownBecomesAProblem) {
    EXPECT_EQ(caught(std::bad_alloc()).status, 503);
    EXPECT_EQ(caught(42).status, 500);
    EXPECT_EQ(caught(ProblemError({410, "gone", "old", ""})).status, 410);
    EXPECT_EQ(caught(Error(ErrorKind::unsupported, "a", "b")).code, "unsupported");
}

TEST(Problem, JsonHasTheMembersOfTheStandard) {
    const Json json = to_json(Problem{422, "invalid_input", "wrong", "here"});
    EXPECT_EQ(json.at("type"), "about:blank");
    EXPECT_EQ(json.at("title"), "Unprocessable Content");
    EXPECT_EQ(json.at("status"), 422);
    EXPECT_EQ(json.at("place"), "here");
    EXPECT_FALSE(to_json(Problem{500, "internal", "x", ""}).contains("place"));
}

}  // namespace
}  // namespace afterglow
