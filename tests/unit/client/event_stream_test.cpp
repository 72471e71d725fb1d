#include "client/event_stream.h"

#include <random>

#include <gmock/gmock.h>

#include "client/error.h"

namespace afterglow::client {

bool operator==(const ServerEvent& a, const ServerEvent& b) {
    return a.name == b.name && a.id == b.id && a.data == b.data;
}
void PrintTo(const ServerEvent& event, std::ostream* out) {
    *out << "{" << event.name << ", " << event.id << ", " << event.data << "}";
}

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<ServerEvent> parse(std::string_view text) {
    return EventStreamParser().feed(text);
}

TEST(EventStream, ReadsNameIdAndData) {
    EXPECT_THAT(parse("event: image\nid: 7\ndata: {\"frame\":1}\n\n"),
                ElementsAre(ServerEvent{"image", "7", "{\"frame\":1}"}));
}

TEST(EventStream, NamesAnEventWithoutANameMessage) {
    EXPECT_THAT(parse("data: x\n\n"), ElementsAre(ServerEvent{"message", "", "x"}));
}

TEST(EventStream, EndsLinesAtLfCrAndCrLf) {
    const ServerEvent expected{"a", "1", "x\ny"};
    EXPECT_THAT(parse("event:a\nid:1\ndata:x\ndata:y\n\n"), ElementsAre(expected));
    EXPECT_THAT(parse("event:a\rid:1\rdata:x\rdata:y\r\r"), ElementsAre(expected));
    EXPECT_THAT(parse("event:a\r\nid:1\r\ndata:x\r\ndata:y\r\n\r\n"), ElementsAre(expected));
}

TEST(EventStream, JoinsDataLinesAndKeepsEmptyOnes) {
    EXPECT_THAT(parse("data: a\ndata\ndata:\ndata: b\n\n"),
                ElementsAre(ServerEvent{"message", "", "a\n\n\nb"}));
}

TEST(EventStream, StripsOneBlankAfterTheColonOnly) {
    EXPECT_THAT(parse("data:  two\ndata:none\n\n"), ElementsAre(ServerEvent{"message", "", " two\nnone"}));
}

TEST(EventStream, PassesOverCommentsUnknownFieldsAndRetry) {
    EXPECT_THAT(parse(": heartbeat\n\nretry: 10\ncolour: red\ndata: x\n\n"),
                ElementsAre(ServerEvent{"message", "", "x"}));
}

TEST(EventStream, KeepsTheIdForLaterEventsAndForgetsTheName) {
    EXPECT_THAT(parse("event: a\nid: 4\ndata: x\n\ndata: y\n\nid\ndata: z\n\n"),
                ElementsAre(ServerEvent{"a", "4", "x"}, ServerEvent{"message", "4", "y"},
                            ServerEvent{"message", "", "z"}));
}

TEST(EventStream, TakesTheIdOfAnEventWithoutData) {
    EXPECT_THAT(parse("event: a\nid: 9\n\ndata: x\n\n"), ElementsAre(ServerEvent{"message", "9", "x"}));
}

TEST(EventStream, IgnoresAnIdWithANullByte) {
    using std::string_view_literals::operator""sv;
    EXPECT_THAT(parse("id: 1\nid: 2\0003\ndata: x\n\n"sv), ElementsAre(ServerEvent{"message", "1", "x"}));
}

TEST(EventStream, NeverReturnsAnEventThatWasCutOff) {
    EXPECT_THAT(parse("event: a\nid: 3\ndata: x\n"), IsEmpty());
}

TEST(EventStream, SkipsAByteOrderMarkAtTheVeryBeginningOnly) {
    EXPECT_THAT(parse("\xEF\xBB\xBF"
                      "data: x\n\n\xEF\xBB\xBF"
                      "data: y\n\ndata: z\n\n"),
                ElementsAre(ServerEvent{"message", "", "x"}, ServerEvent{"message", "", "z"}));
}

TEST(EventStream, RefusesAnEndlessEvent) {
    EventStreamParser parser;
    const std::string megabyte(std::size_t{1} << 20U, 'x');
    const auto feed_all = [&] {
        parser.feed("data: ");
        for (int i = 0; i < 17; ++i) parser.feed(megabyte);
    };
    EXPECT_THROW(feed_all(), ClientError);
}

/// A random stream over the few bytes that mean something, so that every branch is met often.
std::string random_stream(std::mt19937& random) {
    static constexpr std::string_view pieces[] = {
        "event: a", "id: 1", "id", "data: x", "data",         "data:",    ":",      "\n",      "\r",
        "\r\n",     "\n\n",  "z",  " ",       "\xEF\xBB\xBF", "retry: 1", "id: 22", "\r\n\r\n"};
    std::uniform_int_distribution<std::size_t> pick(0, std::size(pieces) - 1);
    std::string text;
    for (int i = 0; i < 60; ++i) text += pieces[pick(random)];
    return text;
}

TEST(EventStream, GivesTheSameEventsHoweverTheBytesAreSplit) {
    std::mt19937 random(1);
    std::size_t events_seen = 0;
    for (int round = 0; round < 500; ++round) {
        const std::string text = random_stream(random);
        const auto whole = parse(text);
        EventStreamParser parser;
        std::vector<ServerEvent> pieces;
        std::uniform_int_distribution<std::size_t> length(0, 1 + static_cast<std::size_t>(round % 9));
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t count = std::min(length(random), text.size() - at);
            for (auto& event : parser.feed(std::string_view(text).substr(at, count))) pieces.push_back(event);
            at += count;
        }
        ASSERT_EQ(pieces, whole) << testing::PrintToString(text);
        events_seen += whole.size();
    }
    EXPECT_GT(events_seen, 1000U) << "the random streams hold too few events to show anything";
}

TEST(EventStream, SurvivesArbitraryBytes) {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> byte(0, 255);
    EventStreamParser parser;
    std::string bytes(100'000, '\0');
    for (char& c : bytes) c = static_cast<char>(byte(random));
    for (const auto& event : parser.feed(bytes)) EXPECT_FALSE(event.name.empty());
    // Whatever came before, a blank line brings the parser back to the start of an event.
    parser.feed("\n\n");
    EXPECT_THAT(parser.feed("id: 5\nevent: b\ndata: ok\n\n"), ElementsAre(ServerEvent{"b", "5", "ok"}));
}

}  // namespace
}  // namespace afterglow::client
