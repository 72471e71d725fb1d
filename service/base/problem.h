#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "solver/base/error.h"
#include "solver/base/json.h"

namespace afterglow {

/// What went wrong, as clients see it (RFC 9457). A value.
struct Problem {
    int status = 500;    ///< HTTP status, 400 to 599
    std::string code;    ///< stable, for programs: "invalid_input", "job_ended", …
    std::string detail;  ///< one line, for people
    std::string place;   ///< the field, file or node; empty where there is none
};

/// Thrown by request handling where an HTTP status is meant that no ErrorKind stands for.
class ProblemError : public std::runtime_error {
  public:
    explicit ProblemError(Problem problem);
    [[nodiscard]] const Problem& problem() const { return problem_; }

  private:
    Problem problem_;
};

/// The standard phrase of a status (RFC 9110).
std::string_view title_of(int status);

/// The one place that turns failures into statuses: unusable input is 422, too large 413, anything of our own
/// 500 without a word about the inside.
Problem problem_of(const Error& error);
/// The same for whatever was caught; what is not an Error or a ProblemError becomes a bare 500.
Problem problem_of(const std::exception_ptr& caught);

/// `{"type","title","status","code","detail"[,"place"]}`.
Json to_json(const Problem& problem);

}  // namespace afterglow
