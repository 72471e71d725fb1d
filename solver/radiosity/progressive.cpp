#include "solver/radiosity/progressive.h"

#include <algorithm>

#include "solver/radiosity/exchange.h"
#include "solver/radiosity/shooting.h"

namespace afterglow {

ProgressiveState make_progressive_state(const RadiosityProblem& problem, const Context& context) {
    check(problem);
    ProgressiveState state;
    state.enclosure = enclosure_of(problem, context);
    check_gain(state.enclosure);
    state.irradiance.reserve(problem.patches());
    state.unshot.reserve(problem.patches());
    float reflected = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb at_once = problem.reflectance[i] * problem.external(i);
        state.irradiance.push_back(problem.external(i));
        state.unshot.push_back(problem.emission[i] + at_once);
        reflected = std::max(reflected, max_channel(at_once));
    }
    state.rounding = gather_rounding * static_cast<double>(reflected);
    return state;
}

Certificate step(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const ProgressiveConfig& config, const Context& context) {
    check_step(state, problem, columns, config);
    return shoot_among(state, problem, columns, config, {}, context);
}

ProgressiveSolution solve_progressive(const RadiosityProblem& problem, const FormFactorColumns& columns,
                                      const ProgressiveConfig& config, const Context& context) {
    ProgressiveSolution solution{make_progressive_state(problem, context), {}};
    solution.certificate = step(solution.state, problem, columns, config, context);
    return solution;
}

}  // namespace afterglow
