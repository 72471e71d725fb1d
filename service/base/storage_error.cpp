#include "service/base/storage_error.h"

#include <cerrno>
#include <system_error>
#include <utility>

namespace afterglow {

StorageError::StorageError(std::string code, std::string place, std::string message)
    : Error(ErrorKind::io, std::move(place), std::move(message)), code_(std::move(code)) {}

StorageError StorageError::of_errno(int number, const std::string& place) {
    // A limit on the size of files (EFBIG) is to its owner what a full disk is.
    const bool full = number == ENOSPC || number == EDQUOT || number == EFBIG;
    const bool read_only = number == EROFS || number == EACCES || number == EPERM;
    return {full        ? "disk_full"
            : read_only ? "disk_read_only"
                        : "io",
            place, std::generic_category().message(number)};
}

}  // namespace afterglow
