#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

/// Uploaded bytes by the SHA-256 of their content, waiting to become a part of a scene, which then has a copy
/// of its own. Past a limit those that were not asked for the longest go. They outlast the process, and what
/// a crash of the machine damages is noticed and dropped. Thread-safety: all members.
class BlobStore {
  public:
    /// Makes the folder and takes over what is in it. Errors: io.
    BlobStore(std::filesystem::path folder, std::uint64_t max_bytes);

    /// Whether a text is a name that a blob can have: 64 digits of lower-case hexadecimal.
    static bool is_name(std::string_view name);

    /// Keeps a blob; `name` must be the hash of its content. False: it was there. Errors: StorageError;
    /// too_large for more than all blobs may have.
    bool put(const std::string& name, std::string_view content);
    /// Whether it is there; if so it was now asked for.
    bool has(const std::string& name);
    /// Its content; nothing where there is none, or no longer.
    std::optional<std::string> get(const std::string& name);

    struct Entry {
        std::string name;
        std::uint64_t bytes = 0;
        std::chrono::system_clock::time_point asked;  ///< for the last time
    };
    [[nodiscard]] std::vector<Entry> list() const;
    /// Removes a blob unless it was asked for after `asked`.
    void remove(const Entry& entry);

  private:
    using Time = std::filesystem::file_time_type;
    struct Blob {
        std::uint64_t bytes = 0;
        Time asked;
    };
    [[nodiscard]] std::filesystem::path file_of(const std::string& name) const { return folder_ / name; }
    void drop(const std::string& name);
    void make_room(std::uint64_t bytes);

    std::filesystem::path folder_;
    std::uint64_t max_bytes_;
    mutable std::mutex mutex_;
    std::map<std::string, Blob> blobs_;
    std::uint64_t total_ = 0;
};

}  // namespace afterglow
