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

}  // namespace
}  // namespace afterglow
