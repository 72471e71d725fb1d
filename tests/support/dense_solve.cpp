#include "tests/support/dense_solve.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace afterglow::test {

namespace {

/// Brings the largest value of the column, from the diagonal down, onto the diagonal.
void pivot(std::vector<double>& a, std::vector<double>& b, std::size_t k) {
    const std::size_t n = b.size();
    std::size_t largest = k;
    for (std::size_t i = k + 1; i < n; ++i)
        if (std::abs(a[i * n + k]) > std::abs(a[largest * n + k])) largest = i;
    if (a[largest * n + k] == 0) throw std::runtime_error("the dense system is singular");
    if (largest == k) return;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[largest * n + j]);
    std::swap(b[k], b[largest]);
}

/// I − ρF for one channel, row after row.
std::vector<double> system_of(const RadiosityProblem& problem, int channel) {
    const std::size_t n = problem.patches();
    const FormFactorMatrix& f = problem.form_factors;
    std::vector<double> a(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const double reflectance = problem.reflectance[i][channel];
        a[i * n + i] = 1;
        for (std::uint64_t e = f.row_begin[i]; e < f.row_begin[i + 1]; ++e)
            a[i * n + f.column[e]] -= reflectance * f.value[e];
    }
    return a;
}

}  // namespace

std::vector<double> solve_dense(std::vector<double> a, std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        pivot(a, b, k);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double share = a[i * n + k] / a[k * n + k];
            for (std::size_t j = k; j < n; ++j) a[i * n + j] -= share * a[k * n + j];
            b[i] -= share * b[k];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t j = i + 1; j < n; ++j) b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
    }
    return b;
}

std::vector<std::array<double, 3>> solve_radiosity(const RadiosityProblem& problem) {
    const std::size_t n = problem.patches();
    std::vector<std::array<double, 3>> radiosity(n);
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<double> b(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double reflectance = problem.reflectance[i][channel];
            b[i] = problem.emission[i][channel] + reflectance * problem.external(i)[channel];
        }
        const std::vector<double> x = solve_dense(system_of(problem, channel), std::move(b));
        for (std::size_t i = 0; i < n; ++i) radiosity[i][static_cast<std::size_t>(channel)] = x[i];
    }
    return radiosity;
}

}  // namespace afterglow::test
