#include "solver/radiosity/certificate.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"

namespace afterglow {

void ReflectedMean::Sum::add(const Sum& other) {
    area += other.area;
    for (int c = 0; c < 3; ++c) power[c] += other.power[c];
}
double ReflectedMean::Sum::largest_channel() const {
    return area > 0 ? std::max({power[0], power[1], power[2]}) / area : 0;
}

void ReflectedMean::add(float area_m2, const Rgb& emission, const Rgb& reflected) {
    const double area = area_m2;
    Sum patch{area, {}};
    for (int c = 0; c < 3; ++c) patch.power[c] = area * static_cast<double>(reflected[c]);
    (max_channel(emission) <= 0 ? others_ : emitters_).add(patch);
}
void ReflectedMean::add(const ReflectedMean& other) {
    others_.add(other.others_);
    emitters_.add(other.emitters_);
}
double ReflectedMean::value() const {
    Sum all = others_;
    all.add(emitters_);
    // What rounding leaves of light that was taken away is none.
    const bool others_are_lit = others_.largest_channel() > gather_rounding * all.largest_channel();
    return others_are_lit ? others_.largest_channel() : all.largest_channel();
}

double mean_reflected(const RadiosityProblem& problem, std::span<const Rgb> irradiance) {
    ReflectedMean mean;
    for (std::size_t i = 0; i < problem.patches(); ++i)
        mean.add(problem.area[i], problem.emission[i], problem.reflectance[i] * irradiance[i]);
    return mean.value();
}

Certificate make_certificate(double residual, double gain, double reflected) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (residual == 0) return {0, gain, 0};
    const double relative = reflected > 0 ? residual / reflected : infinity;
    return {relative, gain, gain < 1 ? relative / (1 - gain) : infinity};
}

Certificate certify(const RadiosityProblem& problem, std::span<const Rgb> irradiance,
                    const Context& context) {
    check(problem);
    if (irradiance.size() != problem.patches())
        throw Error(ErrorKind::invalid_input, "irradiance", "needs one value a patch");
    const std::size_t patches = problem.patches();
    std::vector<Lanes> radiosity(patches);
    for (std::size_t i = 0; i < patches; ++i)
        radiosity[i] = to_lanes(problem.emission[i] + problem.reflectance[i] * irradiance[i]);
    std::vector<Lanes> received(patches);
    gather(problem.form_factors, radiosity, received, context);

    double residual = 0;
    for (std::size_t i = 0; i < patches; ++i) {
        const Rgb balanced = to_rgb(received[i]) + problem.external(i);
        for (int c = 0; c < 3; ++c) {
            const double h = balanced[c];
            const double difference =
                std::abs(h - static_cast<double>(irradiance[i][c])) + gather_rounding * h;
            residual = std::max(residual, static_cast<double>(problem.reflectance[i][c]) * difference);
        }
    }
    return make_certificate(residual, enclosure_of(problem, context).gain,
                            mean_reflected(problem, irradiance));
}

}  // namespace afterglow
