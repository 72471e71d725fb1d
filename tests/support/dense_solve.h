#pragma once

#include <array>
#include <vector>

#include "solver/radiosity/problem.h"

namespace afterglow::test {

/// Solves A x = b by Gaussian elimination with partial pivoting, in double. `a` is square, row after row.
/// Throws std::runtime_error where a pivot is zero.
std::vector<double> solve_dense(std::vector<double> a, std::vector<double> b);

/// The exact radiosity of each patch and channel: the direct solution of B = E + ρ (F B + H0). The oracle for
/// every solution method; cubic in the number of patches.
std::vector<std::array<double, 3>> solve_radiosity(const RadiosityProblem& problem);

}  // namespace afterglow::test
