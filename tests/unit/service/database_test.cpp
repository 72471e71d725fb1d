#include "service/store/database.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/base/problem.h"
#include "service/base/storage_error.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

class DatabaseTest : public testing::Test {
  protected:
    ScratchFolder folder_;
    std::filesystem::path path_ = folder_.path() / "service.db";

    static std::string code_of(const std::function<void()>& action) {
        try {
            action();
        } catch (const StorageError& e) {
            return e.code();
        }
        return "";
    }
};

TEST_F(DatabaseTest, RowsOutlastItAndCellsKeepTheirKind) {
    {
        Database database(path_);
        EXPECT_EQ(database.openings(), 1);
        database.change("INSERT INTO frames VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, 0)",
                        {std::string("a\0b", 3), std::int64_t{7}, std::int64_t{2}, 0.5, Cell(), 0.25, 1.0});
    }
    Database database(path_);
    EXPECT_EQ(database.openings(), 2);
    const auto rows = database.ask("SELECT job, frame, residual, error_bound FROM frames");
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(as_text(rows[0][0]), std::string("a\0b", 3));
    EXPECT_EQ(as_integer(rows[0][1]), 7);
    EXPECT_EQ(as_real(rows[0][2]), 0.5);
    EXPECT_EQ(as_real(rows[0][3]), std::nullopt);
}

TEST_F(DatabaseTest, IsWrittenAheadAndSynchronisedAtEveryCommit) {
    Database database(path_);
    EXPECT_EQ(as_text(database.ask("PRAGMA journal_mode").at(0).at(0)), "wal");
    EXPECT_EQ(as_integer(database.ask("PRAGMA synchronous").at(0).at(0)), 2);
}

TEST_F(DatabaseTest, ChangesTogetherAreAllOrNothing) {
    Database database(path_);
    const auto interrupted = [&] {
        database.together([&] {
            database.change("INSERT INTO paths VALUES ('a', 1)");
            throw std::runtime_error("halfway");
        });
    };
    EXPECT_THROW(interrupted(), std::runtime_error);
    EXPECT_TRUE(database.ask("SELECT * FROM paths").empty());
    database.together([&] { database.change("INSERT INTO paths VALUES ('a', 1)"); });
    EXPECT_EQ(database.ask("SELECT * FROM paths").size(), 1U);
}

TEST_F(DatabaseTest, AFullDiskIsAClearErrorAndLosesNothing) {
    Database database(path_);
    database.change("INSERT INTO scenes VALUES ('kept', 'x')");
    database.limit_pages(16);
    const std::string large(200'000, 'x');
    EXPECT_EQ(code_of([&] { database.change("INSERT INTO scenes VALUES ('large', ?1)", {large}); }),
              "disk_full");
    database.limit_pages(1'000'000);
    EXPECT_EQ(database.ask("SELECT id FROM scenes").size(), 1U);
    database.change("INSERT INTO scenes VALUES ('large', ?1)", {large});
    EXPECT_EQ(database.ask("SELECT id FROM scenes").size(), 2U);
}

TEST_F(DatabaseTest, ADamagedFileIsNotUsed) {
    { const Database database(path_); }
    std::ofstream(path_, std::ios::binary) << std::string(8192, 'x');
    EXPECT_EQ(code_of([&] { const Database database(path_); }), "data_corrupt");
}

TEST_F(DatabaseTest, AFileOfANewerVersionIsNotUsed) {
    { Database(path_).change("PRAGMA user_version = 1000"); }
    EXPECT_EQ(code_of([&] { const Database database(path_); }), "data_corrupt");
}

TEST_F(DatabaseTest, AFolderThatIsNoneIsNamed) {
    EXPECT_NE(code_of([&] { const Database database("/dev/null/service.db"); }), "");
}

TEST(StorageError, IsToldToClientsByItsCode) {
    const auto problem = [](int number) {
        return problem_of(std::make_exception_ptr(StorageError::of_errno(number, "/secret")));
    };
    EXPECT_EQ(problem(ENOSPC).status, 507);
    EXPECT_EQ(problem(ENOSPC).code, "disk_full");
    EXPECT_EQ(problem(EROFS).code, "disk_read_only");
    EXPECT_EQ(problem(EIO).code, "io");
    EXPECT_THAT(problem(EIO).detail, testing::Not(testing::HasSubstr("secret")));
}

TEST_F(DatabaseTest, AFileFromBeforeEditsIsBroughtUpToDate) {
    {
        Database database(path_);
        database.change("DROP TABLE event_logs");
        database.change("DROP INDEX jobs_by_key");
        database.change("DROP INDEX jobs_by_state");
        database.change("DROP TABLE edits");
        database.change("ALTER TABLE frames DROP COLUMN job_revision");
        database.change("ALTER TABLE jobs DROP COLUMN strikes");
        database.change("ALTER TABLE jobs DROP COLUMN strike_frame");
        database.change("INSERT INTO frames VALUES ('job', 3, 4, 0.5, NULL, NULL, 1)");
        database.change("PRAGMA user_version = 2");
    }
    Database database(path_);
    EXPECT_EQ(as_integer(database.ask("SELECT job_revision FROM frames").at(0).at(0)), 0);
    EXPECT_TRUE(database.ask("SELECT * FROM edits").empty());
    EXPECT_TRUE(database.ask("SELECT strikes, strike_frame FROM jobs").empty());
    EXPECT_TRUE(database.ask("SELECT * FROM event_logs").empty());
}

}  // namespace
}  // namespace afterglow
