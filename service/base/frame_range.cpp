#include "service/base/frame_range.h"

#include <charconv>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr int last_possible_frame = 9'999'999;

/// A frame number alone; -1 where the text is anything else.
int frame_number(std::string_view text) {
    int frame = -1;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, frame);
    return error == std::errc() && stop == end && frame <= last_possible_frame ? frame : -1;
}

}  // namespace

FrameRange frame_range(const std::string& place, std::string_view text) {
    const auto dash = text.find('-');
    FrameRange range;
    range.first = frame_number(text.substr(0, dash));
    range.last = dash == std::string_view::npos ? range.first : frame_number(text.substr(dash + 1));
    if (range.first < 0 || range.last < 0)
        throw Error(ErrorKind::invalid_input, place,
                    "expected frames such as 0-96 or 12, found \"" + std::string(text) + "\"");
    if (range.first > range.last)
        throw Error(ErrorKind::invalid_input, place,
                    "the last frame of \"" + std::string(text) + "\" comes before the first");
    return range;
}

}  // namespace afterglow
