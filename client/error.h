#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "client/exit_code.h"

namespace afterglow::client {

/// The client's one exception type: what to tell the user and how to exit. `what()` reads "place: message".
class ClientError : public std::runtime_error {
  public:
    ClientError(ExitCode code, const std::string& place, const std::string& message)
        : std::runtime_error(place.empty() ? message : place + ": " + message), code_(code) {}

    [[nodiscard]] ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

}  // namespace afterglow::client
