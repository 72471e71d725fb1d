#include "solver/radiosity/certificate.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"

namespace afterglow {

namespace {

/// Area-weighted sum of ρH, in double because thousands of small patches must not vanish beside the sum so
/// far.
class ReflectedMean {
  public:
    void add(double area, const Rgb& reflected) {
        area_ += area;
        for (int c = 0; c < 3; ++c) power_[c] += area * static_cast<double>(reflected[c]);
    }
    [[nodiscard]] double largest_channel() const {
        return area_ > 0 ? std::max({power_[0], power_[1], power_[2]}) / area_ : 0;
    }

  private:
    double area_ = 0;
    double power_[3] = {0, 0, 0};
};

}  // namespace

double mean_reflected(const RadiosityProblem& problem, std::span<const Rgb> irradiance) {
    ReflectedMean others;
    ReflectedMean all;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb reflected = problem.reflectance[i] * irradiance[i];
        all.add(problem.area[i], reflected);
        if (max_channel(problem.emission[i]) <= 0) others.add(problem.area[i], reflected);
    }
    // What rounding leaves of light that was taken away is none.
    const bool others_are_lit = others.largest_channel() > gather_rounding * all.largest_channel();
    return others_are_lit ? others.largest_channel() : all.largest_channel();
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
