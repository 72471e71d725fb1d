#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace afterglow {

/// What went wrong, coarsely: enough to choose an exit status or an HTTP status.
enum class ErrorKind {
    invalid_input,    ///< the caller's data breaks a rule; `place` names where
    unsupported,      ///< valid data that needs something we do not do
    not_found,        ///< a named thing does not exist
    too_large,        ///< a size or count is past a stated limit
    io,               ///< reading or writing failed
    cancelled,        ///< the caller asked for a stop
    cannot_converge,  ///< the light would grow without bound (gain of 1 or more)
};

/// The one exception type of the solver. `what()` reads "place: message", one line, ready to be shown.
/// Purpose: every failure names its place (file, JSON pointer, node name, option). Thread-safety: a value.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, std::string place, std::string message);

    [[nodiscard]] ErrorKind kind() const { return kind_; }
    /// File, JSON pointer, node name or option; empty where the whole input is meant.
    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] const std::string& message() const { return message_; }

  private:
    ErrorKind kind_;
    std::string place_;
    std::string message_;
};

/// Something the user should know about that did not stop the work.
struct Warning {
    std::string place;    ///< as in Error
    std::string message;  ///< one sentence
};
using Warnings = std::vector<Warning>;

}  // namespace afterglow
