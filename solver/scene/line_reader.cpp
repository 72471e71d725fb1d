#include "solver/scene/line_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "solver/base/error.h"
#include "solver/scene/resources.h"

namespace afterglow {

namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

std::vector<std::string_view> words_in(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t from = 0; (from = line.find_first_not_of(blanks, from)) != std::string_view::npos;) {
        const auto to = std::min(line.find_first_of(blanks, from), line.size());
        words.push_back(line.substr(from, to - from));
        from = to;
    }
    return words;
}

std::string_view LineReader::take_line() {
    const auto end = std::min(text_.find('\n'), text_.size());
    const auto line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++line_;
    return trimmed(line);
}

bool LineReader::next() {
    words_.clear();
    while (words_.empty()) {
        if (text_.empty()) return false;
        std::string_view line = take_line();
        if (!line.empty() && line.front() == '#') continue;
        first_line_ = line_;
        rest_ = line;
        bool continues = true;
        while (continues) {
            continues = !line.empty() && line.back() == '\\' && !text_.empty();
            if (continues) line.remove_suffix(1);
            const auto words = words_in(line);
            words_.insert(words_.end(), words.begin(), words.end());
            if (continues) line = take_line();
        }
    }
    rest_ = trimmed(rest_.substr(std::min(rest_.size(), words_.front().size())));
    const auto is_comment = [](std::string_view word) { return word.front() == '#'; };
    arguments_.assign(words_.begin() + 1, std::find_if(words_.begin() + 1, words_.end(), is_comment));
    return true;
}

void LineReader::fail(const std::string& message) const {
    throw Error(ErrorKind::invalid_input, place(), message);
}

float LineReader::number(std::size_t k) const {
    if (k >= arguments_.size()) fail("expected another number after " + in_quotes(keyword()));
    std::string_view word = arguments_[k];
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (problem == std::errc::invalid_argument || end != word.data() + word.size())
        fail("expected a number, found " + in_quotes(arguments_[k]));
    const auto narrow = static_cast<float>(value);
    if (problem == std::errc::result_out_of_range || !std::isfinite(narrow))
        fail("the number " + in_quotes(arguments_[k]) + " is not finite or too large");
    return narrow;
}

}  // namespace afterglow
