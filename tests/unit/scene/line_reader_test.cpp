#include "solver/scene/line_reader.h"

#include <gmock/gmock.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

using testing::ElementsAre;

TEST(LineReader, SkipsCommentsAndBlanksAndCountsLines) {
    LineReader lines("# head\r\n\r\n  v 1 2\t3 # tail\r\nf a b", "x.obj");
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.keyword(), "v");
    EXPECT_THAT(lines.arguments(), ElementsAre("1", "2", "3"));
    EXPECT_EQ(lines.place(), "x.obj:3");
    ASSERT_TRUE(lines.next());
    EXPECT_THAT(lines.arguments(), ElementsAre("a", "b"));
    EXPECT_EQ(lines.place(), "x.obj:4");
    EXPECT_FALSE(lines.next());
    EXPECT_FALSE(lines.next());
}

TEST(LineReader, JoinsLinesThatEndInABackslash) {
    LineReader lines("f 1 2 \\\r\n  3 \\\n4\nv\\", "x");
    ASSERT_TRUE(lines.next());
    EXPECT_THAT(lines.arguments(), ElementsAre("1", "2", "3", "4"));
    EXPECT_EQ(lines.place(), "x:1") << "errors name where the statement begins";
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.place(), "x:4");
    EXPECT_EQ(lines.keyword(), "v\\") << "nothing follows to be joined";
}

TEST(LineReader, KeepsBlanksInNames) {
    LineReader lines("usemtl  Oak,  dark #2 \n", "x");
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.rest(), "Oak,  dark #2");
}

TEST(LineReader, ReadsNumbersAsExportersWriteThem) {
    LineReader lines("v 1 -2.5 +3e-2 .5 1e-320", "x");
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.number(0), 1.0F);
    EXPECT_EQ(lines.number(1), -2.5F);
    EXPECT_EQ(lines.number(2), 0.03F);
    EXPECT_EQ(lines.number(3), 0.5F);
    EXPECT_EQ(lines.number(4), 0.0F);
}

TEST(LineReader, RejectsWhatIsNoFiniteNumber) {
    for (const char* bad : {"x", "1x", "nan", "inf", "-inf", "1e999", "1e39", "+-1", "0x10", "1,5"}) {
        const std::string text = std::string("\nv ") + bad;
        LineReader lines(text, "room.obj");
        ASSERT_TRUE(lines.next());
        try {
            static_cast<void>(lines.number(0));
            ADD_FAILURE() << bad << " accepted";
        } catch (const Error& e) {
            EXPECT_EQ(e.place(), "room.obj:2");
        }
    }
}

TEST(LineReader, TakesLinesOfAnyLength) {
    std::string text = "f";
    for (int k = 0; k < 300'000; ++k) text += " 1";
    LineReader lines(text, "x");
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.arguments().size(), 300'000U);
}

}  // namespace
}  // namespace afterglow
