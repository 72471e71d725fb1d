#include "tests/unit/radiosity/problems.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/dense_solve.h"

namespace afterglow::test {

FormFactorMatrix matrix_of(const std::vector<std::vector<double>>& rows) {
    FormFactorMatrix matrix;
    for (const auto& row : rows) {
        for (std::size_t j = 0; j < row.size(); ++j) {
            if (row[j] <= 0) continue;
            matrix.column.push_back(static_cast<Index>(j));
            matrix.value.push_back(static_cast<float>(row[j]));
        }
        matrix.row_begin.push_back(matrix.column.size());
    }
    return matrix;
}

OwnedProblem unit_cube(float reflectance) {
    constexpr double parallel = .199824895698;
    constexpr double perpendicular = .200043776075;
    std::vector<std::vector<double>> rows(6, std::vector<double>(6, perpendicular));
    for (std::size_t i = 0; i < 6; ++i) {
        rows[i][i] = 0;
        rows[i][i ^ 1U] = parallel;
    }
    OwnedProblem cube{matrix_of(rows),
                      std::vector<float>(6, 1.0F),
                      std::vector<Rgb>(6, Rgb(0)),
                      std::vector<Rgb>(6, Rgb(reflectance)),
                      {}};
    cube.emission[0] = Rgb(1);
    return cube;
}

OwnedProblem furnace(std::size_t patches, float reflectance) {
    OwnedProblem problem = random_problem(7, patches, Closure::closed, 0.5F);
    problem.emission.assign(patches, Rgb(1));
    problem.reflectance.assign(patches, Rgb(reflectance));
    problem.external_irradiance.clear();
    return problem;
}

OwnedProblem random_problem(std::uint32_t seed, std::size_t patches, Closure closure,
                            float largest_reflectance) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<std::vector<double>> rows(patches, std::vector<double>(patches, 0.0));
    for (auto& row : rows) {
        double sum = 0;
        // Some rows are sparse, some nearly full, as round a corner and in the middle of a room.
        const double density = 0.1 + 0.9 * uniform(generator);
        for (double& f : row)
            if (uniform(generator) < density) sum += f = uniform(generator);
        if (sum == 0) sum = row[generator() % patches] = 1;
        const double kept = closure == Closure::closed ? 1 : uniform(generator);
        for (double& f : row) f *= kept / sum;
    }
    OwnedProblem problem{matrix_of(rows), {}, {}, {}, {}};
    const auto colour = [&](double scale) {
        return Rgb(scale * uniform(generator), scale * uniform(generator), scale * uniform(generator));
    };
    for (std::size_t i = 0; i < patches; ++i) {
        problem.area.push_back(static_cast<float>(std::pow(10, -2 * uniform(generator))));
        problem.emission.push_back(i == 0 || uniform(generator) < 0.1 ? colour(100) : Rgb(0));
        problem.reflectance.push_back(uniform(generator) < 0.2 ? Rgb(0) : colour(largest_reflectance));
        if (seed % 3 == 0)
            problem.external_irradiance.push_back(uniform(generator) < 0.5 ? Rgb(0) : colour(10));
    }
    return problem;
}

RandomRoles::RandomRoles(std::uint32_t seed, std::size_t patches) {
    std::mt19937 generator(seed + 77);
    for (std::size_t i = 0; i < patches; ++i) {
        seen.push_back(generator() % 2);
        moving.push_back(generator() % 8 == 0);
        surface.push_back(static_cast<Index>(generator() % (1 + patches / 3)));
        object.push_back(surface.back() / 2);
    }
}

double largest_error(const RadiosityProblem& problem, const std::vector<Rgb>& irradiance) {
    const auto exact = solve_radiosity(problem);
    double error = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double shown = static_cast<double>(problem.emission[i][c]) +
                                 static_cast<double>(problem.reflectance[i][c]) * irradiance[i][c];
            error = std::max(error, std::abs(shown - exact[i][static_cast<std::size_t>(c)]));
        }
    return error;
}

ProgressiveSolution solve(const OwnedProblem& problem, double asked_error, ShootingOrder order) {
    ProgressiveConfig config;
    config.asked_error = asked_error;
    config.order = order;
    return solve_progressive(problem.view(), problem.columns(), config, Context(1));
}

}  // namespace afterglow::test
