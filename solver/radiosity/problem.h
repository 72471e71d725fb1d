#pragma once

#include <span>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/formfactor/matrix.h"

namespace afterglow {

/// What is to be solved at one time: B = E + ρ (F B + H0), for each patch and channel.
/// Purpose: the one input of every solution method. The spans and the matrix belong to the caller and must
/// outlive the problem; all have one element a patch.
struct RadiosityProblem {
    const FormFactorMatrix& form_factors;      ///< F, rows of the receivers
    std::span<const float> area;               ///< A, m², above 0
    std::span<const Rgb> emission;             ///< E, W/m²: π × emitted radiance, 0 or more
    std::span<const Rgb> reflectance;          ///< ρ, 0 or more; the gain decides how large it may be
    std::span<const Rgb> external_irradiance;  ///< H0, W/m², from lights without surface and the background,
                                               ///< 0 or more; empty: none

    [[nodiscard]] std::size_t patches() const { return area.size(); }
    [[nodiscard]] Rgb external(std::size_t patch) const {
        return external_irradiance.empty() ? Rgb(0) : external_irradiance[patch];
    }
};

/// Throws Error{invalid_input}, naming field and patch, unless all sizes agree and all values are finite and
/// in their ranges (light at most 1e30). The matrix's columns are checked where it is transposed
/// (columns_of).
void check(const RadiosityProblem& problem);

/// How well a scene holds its light.
struct Enclosure {
    double gain = 0;     ///< g = max_i max_channel(ρ_i) Σ_j F_ij: no bounce keeps more than this share
    double closure = 0;  ///< area-weighted mean of Σ_j F_ij: 1 in a closed scene, less where light escapes
};

/// Σ_j F_ij for some rows, or for all of them. Works in parallel; the same bits for any number of threads.
std::vector<double> row_sums(const FormFactorMatrix& matrix, std::span<const Index> rows,
                             const Context& context);
std::vector<double> row_sums(const FormFactorMatrix& matrix, const Context& context);

/// From the sums of all rows, or summing them first.
Enclosure enclosure_of(const RadiosityProblem& problem, std::span<const double> row_sum);
Enclosure enclosure_of(const RadiosityProblem& problem, const Context& context);

}  // namespace afterglow
