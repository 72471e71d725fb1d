#include "service/base/console.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <unistd.h>

namespace afterglow {

namespace {

constexpr auto redraw_interval = std::chrono::milliseconds(100);
constexpr auto plain_interval = std::chrono::seconds(5);
constexpr const char* erase_line = "\r\033[K";
constexpr std::size_t terminal_width = 79;  // wrapped lines could not be redrawn

std::string progress_text(std::string_view subject, const Progress& progress) {
    const auto seconds = static_cast<long>(std::clamp(progress.remaining.count(), 0.0, 359999.0));
    std::array<char, 48> numbers{};
    std::snprintf(numbers.data(), numbers.size(), "%3.0f %%  %ld:%02ld:%02ld left", 100 * progress.fraction,
                  seconds / 3600, seconds / 60 % 60, seconds % 60);
    return std::string(numbers.data()) + "  " + one_line(subject) + ": " + one_line(progress.doing);
}

}  // namespace

std::string one_line(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) c = '?';
    }
    return out;
}

Console::Console(Shows shows) : shows_(shows), is_terminal_(::isatty(STDERR_FILENO) == 1) {}

Console::~Console() {
    if (line_is_drawn_) std::fputs(erase_line, stderr);
}

void Console::progress(std::string_view subject, const Progress& progress) {
    if (shows_ == Shows::warnings_only) return;
    const std::scoped_lock lock(mutex_);
    const auto now = Clock::now();
    const auto interval = is_terminal_ ? Clock::duration(redraw_interval) : Clock::duration(plain_interval);
    if (now - last_progress_ < interval) return;
    last_progress_ = now;
    const std::string text = progress_text(subject, progress);
    if (is_terminal_) {
        std::fprintf(stderr, "%s%s", erase_line, text.substr(0, terminal_width).c_str());
        line_is_drawn_ = true;
    } else {
        std::fprintf(stderr, "%s\n", text.c_str());
    }
}

void Console::line(std::string_view text) {
    if (shows_ == Shows::progress) add(one_line(text));
}

void Console::warning(const Warning& warning) {
    const std::string place = warning.place.empty() ? "" : warning.place + ": ";
    add("afterglowd: warning: " + one_line(place + warning.message));
}

void Console::add(const std::string& text) {
    const std::scoped_lock lock(mutex_);
    std::fprintf(stderr, "%s%s\n", line_is_drawn_ ? erase_line : "", text.c_str());
    line_is_drawn_ = false;
}

}  // namespace afterglow
