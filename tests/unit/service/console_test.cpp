#include "service/base/console.h"

#include <gtest/gtest.h>

namespace afterglow {
namespace {

TEST(OneLine, ReplacesControlCharactersAndNothingElse) {
    EXPECT_EQ(one_line("wall \"é\" 2~"), "wall \"é\" 2~");
    EXPECT_EQ(one_line("a\nb\r\t\033[2Jc\x7f"), "a?b???[2Jc?");
    EXPECT_EQ(one_line(std::string_view("a\0b", 3)), "a?b");
}

TEST(Console, WarningsAlwaysShowAndLinesUnlessQuiet) {
    testing::internal::CaptureStderr();
    {
        Console quiet(Console::Shows::warnings_only);
        quiet.line("a line");
        quiet.warning({"node", "is odd\n"});
        quiet.progress("frame 1", Progress{});
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "afterglowd: warning: node: is odd?\n");
    testing::internal::CaptureStderr();
    {
        Console plain(Console::Shows::progress);
        plain.line("a line");
        plain.warning({"", "no camera"});
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "a line\nafterglowd: warning: no camera\n");
}

}  // namespace
}  // namespace afterglow
