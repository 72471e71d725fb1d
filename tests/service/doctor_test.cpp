#include "tests/service/service_fixture.h"

namespace afterglow::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

using Doctor = ServiceTest;

TEST_F(Doctor, FindsARunningServerWell) {
    const Outcome outcome = afterglow({"doctor", "--json"});
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    const auto findings = json_lines(outcome.out);
    ASSERT_EQ(findings.size(), 3U);
    EXPECT_EQ(findings[0].at("check"), "server");
    EXPECT_EQ(findings[0].at("result"), "ok");
    EXPECT_EQ(findings[1].at("check"), "access");
    EXPECT_EQ(findings[1].at("result"), "ok");
}

TEST_F(Doctor, SaysThatNothingAnswersAndWhatToDo) {
    // Port 1 (tcpmux) has no listener.
    const Outcome outcome = afterglow({"doctor", "--server", "http://127.0.0.1:1"});
    EXPECT_EQ(outcome.exit, 5);
    EXPECT_THAT(outcome.out, StartsWith("broken  server: http://127.0.0.1:1: cannot be reached"));
    EXPECT_THAT(outcome.out, HasSubstr("afterglowd serve"));
}

}  // namespace
}  // namespace afterglow::test
