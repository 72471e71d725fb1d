#include "solver/radiosity/problem.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "solver/base/error.h"

namespace afterglow {

namespace {

[[noreturn]] void fail(std::string_view field, const std::string& message) {
    throw Error(ErrorKind::invalid_input, std::string(field), message);
}

void check_size(std::size_t size, std::size_t patches, std::string_view field) {
    if (size != patches)
        fail(field, "has " + std::to_string(size) + " values for " + std::to_string(patches) + " patches");
}

/// Light and its sums stay far from the largest float.
constexpr float largest_value = 1e30F;

void check_values(std::span<const Rgb> values, std::string_view field) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Rgb& v = values[i];
        if (!is_finite(v) || v.r < 0 || v.g < 0 || v.b < 0 || max_channel(v) > largest_value)
            fail(field, "patch " + std::to_string(i) + " must lie in [0, 1e30]");
    }
}

}  // namespace

void check(const RadiosityProblem& problem) {
    const std::size_t patches = problem.patches();
    check_size(problem.form_factors.rows(), patches, "form factors");
    check_size(problem.emission.size(), patches, "emission");
    check_size(problem.reflectance.size(), patches, "reflectance");
    if (!problem.external_irradiance.empty())
        check_size(problem.external_irradiance.size(), patches, "external irradiance");
    for (std::size_t i = 0; i < patches; ++i)
        if (const float a = problem.area[i]; !(a > 0) || a - a != 0.0F)
            fail("area", "patch " + std::to_string(i) + " must be finite and above 0");
    check_values(problem.emission, "emission");
    check_values(problem.reflectance, "reflectance");
    check_values(problem.external_irradiance, "external irradiance");
}

std::vector<double> row_sums(const FormFactorMatrix& matrix, std::span<const Index> rows,
                             const Context& context) {
    constexpr std::size_t chunk = 512;
    std::vector<double> sums(rows.size());
    context.for_chunks(rows.size(), chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            double sum = 0;
            for (std::uint64_t e = matrix.row_begin[rows[k]]; e < matrix.row_begin[rows[k] + 1]; ++e)
                sum += matrix.value[e];
            sums[k] = sum;
        }
    });
    return sums;
}

std::vector<double> row_sums(const FormFactorMatrix& matrix, const Context& context) {
    std::vector<Index> all(matrix.rows());
    std::iota(all.begin(), all.end(), Index{0});
    return row_sums(matrix, all, context);
}

Enclosure enclosure_of(const RadiosityProblem& problem, std::span<const double> row_sum) {
    double gain = 0;
    double area = 0;
    double seen = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        gain = std::max(gain, static_cast<double>(max_channel(problem.reflectance[i])) * row_sum[i]);
        area += problem.area[i];
        seen += problem.area[i] * row_sum[i];
    }
    return {gain, area > 0 ? seen / area : 0};
}

Enclosure enclosure_of(const RadiosityProblem& problem, const Context& context) {
    return enclosure_of(problem, row_sums(problem.form_factors, context));
}

}  // namespace afterglow
