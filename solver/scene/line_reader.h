#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// Goes through the statements of a text file of the Wavefront kind (.obj, .mtl): one a line, words parted by
/// blanks, lines that begin with # left out, a backslash at the end of a line joining it with the next. Lines
/// end in LF or CRLF and may be of any length. A view: the text must outlive it.
class LineReader {
  public:
    /// `name` stands for the file in errors.
    LineReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

    /// Goes to the next statement; false at the end.
    bool next();

    /// The first word of the statement.
    [[nodiscard]] std::string_view keyword() const { return words_.front(); }
    /// The words after it, without a comment that begins with a word starting in #.
    [[nodiscard]] const std::vector<std::string_view>& arguments() const { return arguments_; }
    /// All that follows the keyword, blanks inside kept: for names. Joined lines: the first line's part.
    [[nodiscard]] std::string rest() const { return std::string(rest_); }

    /// "file:line" of the statement, for errors and warnings.
    [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(first_line_); }
    [[noreturn]] void fail(const std::string& message) const;

    /// Argument `k` as a finite number within the range of single precision. Errors: invalid_input.
    [[nodiscard]] float number(std::size_t k) const;

  private:
    [[nodiscard]] std::string_view take_line();

    std::string_view text_;
    std::string name_;
    std::size_t line_ = 0;
    std::size_t first_line_ = 0;
    std::vector<std::string_view> words_;
    std::vector<std::string_view> arguments_;
    std::string_view rest_;
};

/// Words parted by blanks, tabs and the like.
std::vector<std::string_view> words_in(std::string_view line);

}  // namespace afterglow
