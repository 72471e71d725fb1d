#include "solver/formfactor/matrix.h"

#include <algorithm>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "solver/base/error.h"

namespace afterglow {
namespace {

/// Random rows; columns unsorted and at times repeated, some rows and columns empty.
FormFactorMatrix random_matrix(std::uint32_t seed, std::size_t patches, std::size_t largest_row) {
    std::mt19937 generator(seed);
    FormFactorMatrix matrix;
    for (std::size_t i = 0; i < patches; ++i) {
        const std::size_t entries = generator() % 4 == 0 ? 0 : generator() % (largest_row + 1);
        for (std::size_t e = 0; e < entries; ++e) {
            matrix.column.push_back(static_cast<Index>(generator() % patches / 2 * 2));
            matrix.value.push_back(static_cast<float>(generator() % 1000 + 1) / 1000);
        }
        matrix.row_begin.push_back(matrix.column.size());
    }
    return matrix;
}

using Entry = std::tuple<std::size_t, std::size_t, float>;  // row, column, value

std::vector<Entry> entries_of(const FormFactorMatrix& matrix) {
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < matrix.rows(); ++i)
        for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e)
            entries.emplace_back(i, matrix.column[e], matrix.value[e]);
    std::sort(entries.begin(), entries.end());
    return entries;
}

std::vector<Entry> entries_of(const FormFactorColumns& columns) {
    std::vector<Entry> entries;
    for (std::size_t c = 0; c + 1 < columns.column_begin.size(); ++c)
        for (std::uint64_t e = columns.column_begin[c]; e < columns.column_begin[c + 1]; ++e)
            entries.emplace_back(columns.row[e], c, columns.value[e]);
    std::sort(entries.begin(), entries.end());
    return entries;
}

TEST(Columns, HoldTheSameEntriesWithRowsInOrder) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const std::size_t patches = seed * 13 % 97;
        const FormFactorMatrix matrix = random_matrix(seed, patches, 1 + seed % 40);
        const FormFactorColumns columns = columns_of(matrix, Context(1 + static_cast<int>(seed % 4)));
        ASSERT_EQ(columns.column_begin.size(), patches + 1);
        ASSERT_EQ(entries_of(columns), entries_of(matrix)) << "seed " << seed;
        for (std::size_t c = 0; c < patches; ++c)
            ASSERT_TRUE(std::is_sorted(
                columns.row.begin() + static_cast<std::ptrdiff_t>(columns.column_begin[c]),
                columns.row.begin() + static_cast<std::ptrdiff_t>(columns.column_begin[c + 1])));
    }
}

TEST(Columns, OfColumnsAreTheRowsAgain) {
    const FormFactorMatrix matrix = random_matrix(1, 300, 50);
    FormFactorColumns columns = columns_of(matrix, Context(2));
    const FormFactorMatrix transposed{columns.column_begin, columns.row, columns.value};
    const FormFactorColumns back = columns_of(transposed, Context(2));
    EXPECT_EQ(back.column_begin, matrix.row_begin);
    EXPECT_EQ(entries_of(FormFactorMatrix{back.column_begin, back.row, back.value}), entries_of(matrix));
}

TEST(Columns, AreTheSameForAnyNumberOfThreads) {
    const FormFactorMatrix matrix = random_matrix(2, 1000, 100);
    const FormFactorColumns one = columns_of(matrix, Context(1));
    for (const int threads : {2, 3, 8}) {
        const FormFactorColumns several = columns_of(matrix, Context(threads));
        EXPECT_EQ(several.column_begin, one.column_begin);
        EXPECT_EQ(several.row, one.row);
        EXPECT_EQ(several.value, one.value);
    }
}

TEST(Columns, OfNothingAreEmpty) {
    EXPECT_EQ(columns_of(FormFactorMatrix{}, Context(3)).column_begin, std::vector<std::uint64_t>{0});
}

TEST(Columns, RejectABrokenMatrix) {
    const auto fails = [](const FormFactorMatrix& matrix) {
        try {
            columns_of(matrix, Context(2));
            return false;
        } catch (const Error& error) {
            return error.kind() == ErrorKind::invalid_input;
        }
    };
    EXPECT_FALSE(fails({{0, 1, 2}, {1, 0}, {.5F, .5F}}));
    EXPECT_TRUE(fails({{0, 1, 2}, {1, 2}, {.5F, .5F}}));  // there is no patch 2
    EXPECT_TRUE(fails({{0, 2, 1}, {1, 0}, {.5F, .5F}}));  // offsets run backwards
    EXPECT_TRUE(fails({{0, 1, 3}, {1, 0}, {.5F, .5F}}));  // offsets run past the entries
    EXPECT_TRUE(fails({{1, 1, 2}, {1, 0}, {.5F, .5F}}));  // the first entry is in no row
    EXPECT_TRUE(fails({{0, 1, 2}, {1, 0}, {.5F}}));       // a value is missing
    EXPECT_TRUE(fails({{}, {}, {}}));                     // no offsets at all
}

}  // namespace
}  // namespace afterglow
