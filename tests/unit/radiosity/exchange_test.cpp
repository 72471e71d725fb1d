#include "solver/radiosity/exchange.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;

TEST(Exchange, GatherIsAsExactAsItSays) {
    // Rows of all lengths from 0 to 400, so that runs of four end everywhere.
    FormFactorMatrix matrix;
    for (std::size_t i = 0; i <= 400; ++i) {
        for (std::size_t e = 0; e < i; ++e) {
            matrix.column.push_back(static_cast<Index>((e * 7919 + i) % 401));
            matrix.value.push_back(1.0F / static_cast<float>(i + e));
        }
        matrix.row_begin.push_back(matrix.column.size());
    }
    std::vector<Lanes> light(401);
    for (std::size_t i = 0; i <= 400; ++i) {
        const auto x = static_cast<float>(i);
        light[i] = to_lanes(Rgb(x, 1 / (1 + x), x * x));
    }
    std::vector<Lanes> received(401);
    gather(matrix, light, received, Context(2));
    for (std::size_t i = 0; i <= 400; ++i)
        for (int c = 0; c < 3; ++c) {
            double exact = 0;
            for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e)
                exact += static_cast<double>(matrix.value[e]) * light[matrix.column[e]].v[c];
            EXPECT_NEAR(received[i].v[c], exact, gather_rounding * exact) << "row " << i;
        }
}

TEST(Exchange, ShootingAllPatchesEqualsGathering) {
    const OwnedProblem problem = test::random_problem(11, 80, test::Closure::open, 0.9F);
    std::vector<Index> all(80);
    std::iota(all.begin(), all.end(), 0U);
    std::vector<Lanes> light;
    for (const Rgb& b : problem.reflectance) light.push_back(to_lanes(b));
    std::vector<Lanes> gathered(80);
    std::vector<Lanes> shot(80, to_lanes(Rgb(1)));
    gather(problem.matrix, light, gathered, Context(1));
    shoot(problem.columns(), all, problem.reflectance, shot, Context(1));
    for (std::size_t i = 0; i < 80; ++i)
        for (int c = 0; c < 3; ++c)
            // 80 additions in float to a value of up to 2; the 1 was there before.
            EXPECT_NEAR(shot[i].v[c], 1 + gathered[i].v[c], 80 * 2 * 0x1p-24);
}

TEST(Exchange, SomeRowsGatherWhatAllDo) {
    const OwnedProblem problem = test::random_problem(4, 700, test::Closure::open, 0.9F);
    std::vector<Lanes> light;
    for (const Rgb& b : problem.reflectance) light.push_back(to_lanes(b));
    std::vector<Lanes> all(700);
    gather(problem.matrix, light, all, Context(1));
    std::vector<Index> rows;
    for (Index i = 699; i < 700; i -= 2) rows.push_back(i);
    std::vector<Lanes> some(rows.size());
    gather_rows(problem.matrix, rows, light, some, Context(2));
    for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_EQ(to_rgb(some[k]), to_rgb(all[rows[k]]));
}

TEST(Exchange, OnlyActivePatchesReceive) {
    const OwnedProblem problem = test::random_problem(11, 80, test::Closure::open, 0.9F);
    const FormFactorColumns columns = problem.columns();
    std::vector<std::uint8_t> active(80);
    std::uint64_t entries = 0;
    for (std::size_t i = 0; i < 80; ++i) {
        active[i] = i % 3 == 0 ? 1 : 0;
        if (active[i] != 0) entries += problem.matrix.row_begin[i + 1] - problem.matrix.row_begin[i];
    }
    std::vector<Index> every(80);
    std::iota(every.begin(), every.end(), 0U);
    std::vector<Lanes> to_all(80);
    std::vector<Lanes> to_some(80);
    shoot(columns, every, problem.reflectance, to_all, Context(1));
    EXPECT_EQ(shoot_to_active(columns, every, problem.reflectance, active, to_some, Context(1)), entries);
    for (std::size_t i = 0; i < 80; ++i)
        EXPECT_EQ(to_rgb(to_some[i]), active[i] != 0 ? to_rgb(to_all[i]) : Rgb(0));
}

}  // namespace
}  // namespace afterglow
