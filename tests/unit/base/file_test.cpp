#include "solver/base/file.h"

#include <filesystem>
#include <iterator>
#include <unistd.h>

#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("afterglow_file_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    [[nodiscard]] auto entries() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }
    template <class Action>
    static ErrorKind kind_of_failure(const Action& action, const fs::path& place) {
        try {
            action();
        } catch (const Error& e) {
            EXPECT_EQ(e.place(), place.string());
            return e.kind();
        }
        ADD_FAILURE() << "no failure at " << place;
        return ErrorKind::cancelled;
    }

    fs::path folder_;
};

TEST_F(File, WhatIsWrittenIsRead) {
    for (const std::string& content : {std::string(), std::string("a\0b\r\n", 5), std::string(100000, 'x')}) {
        write_file(folder_ / "f", content);
        EXPECT_EQ(read_file(folder_ / "f"), content);
        EXPECT_EQ(entries(), 1);
    }
}

TEST_F(File, ReadingSaysWhatIsWrong) {
    const fs::path file = folder_ / "f";
    EXPECT_EQ(kind_of_failure([&] { read_file(file); }, file), ErrorKind::not_found);
    EXPECT_EQ(kind_of_failure([&] { read_file(folder_); }, folder_), ErrorKind::io);
    write_file(file, "12345");
    EXPECT_EQ(read_file(file, 5), "12345");
    EXPECT_EQ(kind_of_failure([&] { read_file(file, 4); }, file), ErrorKind::too_large);
}

TEST_F(File, AFailedWriteLeavesNothing) {
    const fs::path nowhere = folder_ / "missing" / "f";
    EXPECT_EQ(kind_of_failure([&] { write_file(nowhere, "x"); }, nowhere), ErrorKind::io);
    EXPECT_EQ(entries(), 0);
    // The rename onto a folder fails after the temporary file was written.
    fs::create_directory(folder_ / "taken");
    EXPECT_EQ(kind_of_failure([&] { write_file(folder_ / "taken", "x"); }, folder_ / "taken"), ErrorKind::io);
    EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace afterglow
