#include "service/store/data_lock.h"

#include <memory>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/service/fake_solver.h"

namespace afterglow {
namespace {

TEST(DataLock, ASecondOneIsToldWhoHoldsTheFolder) {
    const ScratchFolder folder;
    auto first = std::make_unique<DataLock>(folder.path() / "data");
    try {
        const DataLock second(folder.path() / "data");
        FAIL() << "both hold it";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::io);
        EXPECT_THAT(e.message(), testing::HasSubstr("in use by process " + std::to_string(::getpid())));
    }
    first.reset();
    const DataLock third(folder.path() / "data");
}

TEST(DataLock, AFolderThatCannotBeIsNamed) {
    const ScratchFolder folder;
    EXPECT_THROW(DataLock("/dev/null/data"), Error);
}

}  // namespace
}  // namespace afterglow
