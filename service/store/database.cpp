#include "service/store/database.h"

#include <array>
#include <memory>
#include <sqlite3.h>
#include <utility>

#include "service/base/storage_error.h"

namespace afterglow {

namespace {

/// Step n brings a file from version n to n + 1. Steps are never changed, only added.
constexpr std::array migrations = {
    "CREATE TABLE openings (number INTEGER NOT NULL);"
    "INSERT INTO openings VALUES (0);"
    "CREATE TABLE scenes (id TEXT PRIMARY KEY, body TEXT NOT NULL) WITHOUT ROWID;"
    "CREATE TABLE paths (id TEXT PRIMARY KEY, bytes INTEGER NOT NULL) WITHOUT ROWID;"
    "CREATE TABLE jobs (number INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, body TEXT NOT "
    "NULL);"
    "CREATE TABLE frames (job TEXT NOT NULL, frame INTEGER NOT NULL, revision INTEGER NOT NULL, residual "
    "REAL,"
    " error_bound REAL, picture_error REAL, seconds REAL, PRIMARY KEY (job, frame)) WITHOUT ROWID;",
    // For a change that can always be made, to see whether any can.
    "CREATE TABLE probe (number INTEGER NOT NULL);"
    "INSERT INTO probe VALUES (0);",
    // Each row is one request's edits; each frame says after how many of them it was computed.
    "CREATE TABLE edits (job TEXT NOT NULL, revision INTEGER NOT NULL, first_frame INTEGER NOT NULL, body "
    "TEXT NOT NULL, reused REAL, PRIMARY KEY (job, revision)) WITHOUT ROWID;"
    "ALTER TABLE frames ADD COLUMN job_revision INTEGER NOT NULL DEFAULT 0;",
    "ALTER TABLE jobs ADD COLUMN strikes INTEGER NOT NULL DEFAULT 0;"
    "ALTER TABLE jobs ADD COLUMN strike_frame INTEGER NOT NULL DEFAULT 0;",
    // The events of jobs that have ended, each job's as one text; and what jobs are looked for by.
    "CREATE TABLE event_logs (job TEXT PRIMARY KEY, body TEXT NOT NULL) WITHOUT ROWID;"
    "CREATE INDEX jobs_by_key ON jobs (json_extract(body, '$.owner'), json_extract(body, '$.key'));"
    "CREATE INDEX jobs_by_state ON jobs (json_extract(body, '$.state'));",
};

constexpr int busy_ms = 5000;

struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

[[noreturn]] void fail(int result, sqlite3* handle, const std::string& place) {
    const std::string message = handle != nullptr ? sqlite3_errmsg(handle) : sqlite3_errstr(result);
    switch (result & 0xff) {
        case SQLITE_FULL:
            throw StorageError("disk_full", place, message);
        case SQLITE_READONLY:
        case SQLITE_PERM:
            throw StorageError("disk_read_only", place, message);
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            throw StorageError("data_corrupt", place, message);
        case SQLITE_IOERR:
            if (const int number = sqlite3_system_errno(handle); number != 0)
                throw StorageError::of_errno(number, place);
            break;
        default:
            break;
    }
    throw StorageError("io", place, message);
}

void bind(sqlite3_stmt* statement, int index, const Cell& cell) {
    if (const auto* integer = std::get_if<std::int64_t>(&cell))
        sqlite3_bind_int64(statement, index, *integer);
    else if (const auto* real = std::get_if<double>(&cell))
        sqlite3_bind_double(statement, index, *real);
    else if (const auto* text = std::get_if<std::string>(&cell))
        sqlite3_bind_text64(statement, index, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    else
        sqlite3_bind_null(statement, index);
}

Cell read_cell(sqlite3_stmt* statement, int column) {
    switch (sqlite3_column_type(statement, column)) {
        case SQLITE_INTEGER:
            return std::int64_t{sqlite3_column_int64(statement, column)};
        case SQLITE_FLOAT:
            return sqlite3_column_double(statement, column);
        case SQLITE_NULL:
            return {};
        default: {
            const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
            const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
            return bytes == nullptr ? std::string() : std::string(bytes, size);
        }
    }
}

}  // namespace

Database::Database(const std::filesystem::path& path) : place_(path.string()) {
    const int result =
        sqlite3_open_v2(path.c_str(), &handle_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    try {
        if (result != SQLITE_OK) fail(result, handle_, place_);
        sqlite3_extended_result_codes(handle_, 1);
        sqlite3_busy_timeout(handle_, busy_ms);
        ask("PRAGMA journal_mode=WAL");
        ask("PRAGMA synchronous=FULL");
        const auto check = ask("PRAGMA quick_check(1)");
        if (check.empty() || as_text(check[0][0]) != "ok")
            throw StorageError("data_corrupt", place_,
                               "the database is damaged: " + (check.empty() ? "" : as_text(check[0][0])));
        migrate();
        change("UPDATE openings SET number = number + 1");
        openings_ = as_integer(ask("SELECT number FROM openings").at(0).at(0));
    } catch (...) {
        sqlite3_close(handle_);
        throw;
    }
}

Database::~Database() {
    sqlite3_close(handle_);
}

void Database::migrate() {
    const auto version = as_integer(ask("PRAGMA user_version").at(0).at(0));
    const auto newest = static_cast<std::int64_t>(migrations.size());
    if (version > newest)
        throw StorageError("data_corrupt", place_, "the database was made by a newer version");
    for (auto step = version; step < newest; ++step)
        together([&] {
            const int result =
                sqlite3_exec(handle_, migrations[static_cast<std::size_t>(step)], nullptr, nullptr, nullptr);
            if (result != SQLITE_OK) fail(result, handle_, place_);
            change("PRAGMA user_version = " + std::to_string(step + 1));
        });
}

std::vector<Row> Database::ask(const std::string& sql, const Row& values) {
    const std::lock_guard lock(mutex_);
    sqlite3_stmt* raw = nullptr;
    const int prepared = sqlite3_prepare_v2(handle_, sql.c_str(), -1, &raw, nullptr);
    const Statement statement(raw);
    if (prepared != SQLITE_OK) fail(prepared, handle_, place_);
    for (std::size_t i = 0; i < values.size(); ++i) bind(raw, static_cast<int>(i) + 1, values[i]);
    std::vector<Row> rows;
    for (;;) {
        const int result = sqlite3_step(raw);
        if (result == SQLITE_DONE) return rows;
        if (result != SQLITE_ROW) fail(result, handle_, place_);
        Row row;
        for (int column = 0; column < sqlite3_column_count(raw); ++column)
            row.push_back(read_cell(raw, column));
        rows.push_back(std::move(row));
    }
}

void Database::change(const std::string& sql, const Row& values) {
    ask(sql, values);
}

void Database::together(const std::function<void()>& changes) {
    const std::lock_guard lock(mutex_);
    change("BEGIN IMMEDIATE");
    try {
        changes();
        change("COMMIT");
    } catch (...) {
        // Some failures have rolled back already.
        if (sqlite3_get_autocommit(handle_) == 0)
            sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr);
        throw;
    }
}

void Database::limit_pages(std::int64_t pages) {
    ask("PRAGMA max_page_count = " + std::to_string(pages));
}

std::int64_t as_integer(const Cell& cell) {
    const auto* value = std::get_if<std::int64_t>(&cell);
    return value == nullptr ? 0 : *value;
}

std::string as_text(const Cell& cell) {
    const auto* value = std::get_if<std::string>(&cell);
    return value == nullptr ? std::string() : *value;
}

std::optional<double> as_real(const Cell& cell) {
    if (const auto* real = std::get_if<double>(&cell)) return *real;
    if (const auto* integer = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*integer);
    return std::nullopt;
}

Cell cell_of(const std::optional<double>& value) {
    return value ? Cell(*value) : Cell();
}

}  // namespace afterglow
