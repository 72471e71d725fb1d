#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

struct sqlite3;

namespace afterglow {

/// A value of a column.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
using Row = std::vector<Cell>;

/// The service's database: one SQLite file in the data folder, written ahead (WAL) and synchronised at every
/// commit, so that what `change` has returned from outlasts a crash of the machine. The only user of SQLite.
/// Errors of all members: StorageError. Thread-safety: all members.
class Database {
  public:
    /// Opens or makes the file, checks that it is whole and brings its tables up to date. Also data_corrupt
    /// for a damaged file, and for one that a newer version made.
    explicit Database(const std::filesystem::path& path);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    /// The rows that a statement gives; `?1`, `?2`, … stand for the values.
    std::vector<Row> ask(const std::string& sql, const Row& values = {});
    /// A statement without rows, durable on return unless within `together`.
    void change(const std::string& sql, const Row& values = {});
    /// Everything that `changes` does becomes durable as a whole, or nothing of it where it throws.
    void together(const std::function<void()>& changes);

    /// How often this file has been opened, this time included; from 1.
    [[nodiscard]] std::int64_t openings() const { return openings_; }
    /// The file may not grow past this many pages (of 4096 bytes); for tests of a full disk.
    void limit_pages(std::int64_t pages);

  private:
    void migrate();

    std::string place_;
    std::recursive_mutex mutex_;
    sqlite3* handle_ = nullptr;
    std::int64_t openings_ = 0;
};

std::int64_t as_integer(const Cell& cell);
std::string as_text(const Cell& cell);
std::optional<double> as_real(const Cell& cell);
Cell cell_of(const std::optional<double>& value);

}  // namespace afterglow
