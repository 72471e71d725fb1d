#pragma once

#include <vector>

#include "solver/base/math.h"
#include "solver/radiosity/problem.h"
#include "solver/radiosity/progressive.h"

namespace afterglow {

/// Cohen's ambient term: the irradiance, W/m², that the light still unshot would bring to a patch if it
/// spread evenly over all surfaces, c ū / (1 − c ρ̄) per channel, with ū and ρ̄ the area-weighted means of
/// unshot radiosity and reflectance and c the closure (c = 1, Cohen's case, in a closed scene). Added to the
/// state's irradiance in preliminary pictures only; it never enters the solution. Never negative. Zero for no
/// patches. Source: Cohen et al. 1988, section 4, equations for R and the ambient radiosity.
Rgb ambient_irradiance(const RadiosityProblem& problem, const ProgressiveState& state);

/// The state's irradiance with the ambient term added: what a preliminary picture shows, one value a patch.
std::vector<Rgb> irradiance_with_ambient(const RadiosityProblem& problem, const ProgressiveState& state);

}  // namespace afterglow
