#include "service/store/durable_file.h"

#include <cerrno>
#include <fcntl.h>
#include <set>
#include <string>
#include <unistd.h>

#include "service/base/storage_error.h"

namespace afterglow {

namespace {

constexpr std::string_view unfinished_mark = ".part";

/// A file descriptor that closes itself.
class Descriptor {
  public:
    Descriptor(const std::filesystem::path& path, int flags)
        : number_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int number() const { return number_; }

  private:
    int number_;
};

bool write_all(int file, std::string_view content) {
    while (!content.empty()) {
        const auto size = ::write(file, content.data(), content.size());
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) return false;
        content.remove_prefix(static_cast<std::size_t>(size));
    }
    return true;
}

void sync(const std::filesystem::path& path, int flags) {
    const Descriptor file(path, flags);
    if (file.number() < 0 && errno == ENOENT) return;
    if (file.number() < 0 || ::fsync(file.number()) != 0) throw StorageError::of_errno(errno, path.string());
}

}  // namespace

void put_file(const std::filesystem::path& path, std::string_view content) {
    const std::string temporary = path.string() + std::string(unfinished_mark);
    int failure = 0;
    {
        const Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
        if (file.number() < 0 || !write_all(file.number(), content)) failure = errno;
    }
    if (failure == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) failure = errno;
    if (failure == 0) return;
    ::unlink(temporary.c_str());
    throw StorageError::of_errno(failure, path.string());
}

void make_durable(const std::vector<std::filesystem::path>& files) {
    std::set<std::filesystem::path> folders;
    for (const auto& file : files) {
        sync(file, O_RDONLY);
        folders.insert(file.parent_path());
    }
    // A folder made for the files is itself an entry of the one above it.
    for (const auto& folder : std::set(folders)) folders.insert(folder.parent_path());
    for (const auto& folder : folders) sync(folder, O_RDONLY | O_DIRECTORY);
}

}  // namespace afterglow
