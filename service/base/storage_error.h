#pragma once

#include <string>

#include "solver/base/error.h"

namespace afterglow {

/// The disk could not take or give what it should. Kind io, with a code for clients: `disk_full`,
/// `disk_read_only`, `data_corrupt` or `io`.
class StorageError : public Error {
  public:
    StorageError(std::string code, std::string place, std::string message);
    /// By the number that a failed system call left.
    static StorageError of_errno(int number, const std::string& place);

    [[nodiscard]] const std::string& code() const { return code_; }

  private:
    std::string code_;
};

}  // namespace afterglow
