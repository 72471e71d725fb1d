#include "service/store/data_lock.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

#include "solver/base/error.h"

namespace afterglow {

namespace {

std::string holder_of(int file) {
    std::array<char, 32> text{};
    const auto size = ::pread(file, text.data(), text.size(), 0);
    std::string holder;
    for (int i = 0;
         i < size && text[static_cast<std::size_t>(i)] >= '0' && text[static_cast<std::size_t>(i)] <= '9';
         ++i)
        holder += text[static_cast<std::size_t>(i)];
    return holder.empty() ? "another process" : "process " + holder;
}

}  // namespace

DataLock::DataLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::io, folder.string(), error.message());
    const std::filesystem::path path = folder / "lock";
    file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) throw Error(ErrorKind::io, path.string(), std::strerror(errno));
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
        const std::string holder = holder_of(file_);
        ::close(file_);
        throw Error(ErrorKind::io, folder.string(), "this data folder is in use by " + holder);
    }
    // Only for people, so a disk that is full is no reason to stop here.
    const std::string self = std::to_string(::getpid()) + "\n";
    if (::ftruncate(file_, 0) == 0 && ::pwrite(file_, self.data(), self.size(), 0) < 0) errno = 0;
}

DataLock::~DataLock() {
    ::close(file_);
}

}  // namespace afterglow
