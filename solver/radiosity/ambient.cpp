#include "solver/radiosity/ambient.h"

#include <algorithm>

namespace afterglow {

Rgb ambient_irradiance(const RadiosityProblem& problem, const ProgressiveState& state) {
    // In double: thousands of small patches must not vanish beside the sum so far.
    double area = 0;
    double unshot[3] = {0, 0, 0};
    double reflectance[3] = {0, 0, 0};
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        area += problem.area[i];
        for (int c = 0; c < 3; ++c) {
            unshot[c] += static_cast<double>(problem.area[i]) * state.unshot[i][c];
            reflectance[c] += static_cast<double>(problem.area[i]) * problem.reflectance[i][c];
        }
    }
    Rgb ambient(0);
    if (area <= 0) return ambient;
    const double closure = std::min(state.enclosure.closure, 1.0);
    for (int c = 0; c < 3; ++c) {
        // Where reflective patches see only the sky the mean may reach 1 although no patch's gain does.
        const double kept = std::min(closure * reflectance[c] / area, 0.99);
        ambient[c] = static_cast<float>(std::max(0.0, closure * unshot[c] / area / (1 - kept)));
    }
    return ambient;
}

std::vector<Rgb> irradiance_with_ambient(const RadiosityProblem& problem, const ProgressiveState& state) {
    std::vector<Rgb> irradiance = state.irradiance;
    const Rgb ambient = ambient_irradiance(problem, state);
    for (Rgb& h : irradiance) h += ambient;
    return irradiance;
}

}  // namespace afterglow
