#include "solver/radiosity/progressive.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"

namespace afterglow {

namespace {

float largest_magnitude(const Rgb& c) {
    return max_channel(glm::abs(c));
}

/// Unshot power, W; in double because the product must not vanish while light is left.
double unshot_power(const ProgressiveState& state, const RadiosityProblem& problem, std::size_t patch) {
    return static_cast<double>(largest_magnitude(state.unshot[patch])) * problem.area[patch];
}

/// What decides the next batch; a function of the state alone.
struct Survey {
    float unshot = 0;       ///< largest |ΔB|, W/m²
    double power = 0;       ///< largest |ΔB| A, W
    std::size_t patch = 0;  ///< the first one that has it
    Certificate certificate;
    bool only_rounding = false;  ///< what is left unshot is far less than what rounding hides
};

Survey survey(const ProgressiveState& state, const RadiosityProblem& problem) {
    Survey result;
    float reflected = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const double power = unshot_power(state, problem, i);
        result.unshot = std::max(result.unshot, largest_magnitude(state.unshot[i]));
        if (power > result.power) {
            result.power = power;
            result.patch = i;
        }
        reflected = std::max(reflected, max_channel(problem.reflectance[i] * state.irradiance[i]));
    }
    const double left = state.enclosure.gain * static_cast<double>(result.unshot);
    const double rounding = gather_rounding * static_cast<double>(reflected);
    result.certificate =
        make_certificate(left + rounding, state.enclosure.gain, mean_reflected(problem, state.irradiance));
    result.only_rounding = 8 * left <= rounding;
    return result;
}

/// The shooting patches of the next batch, in index order.
std::vector<Index> choose(const ProgressiveState& state, const RadiosityProblem& problem, const Survey& now,
                          ShootingOrder order) {
    if (order == ShootingOrder::largest_first) return {static_cast<Index>(now.patch)};
    std::vector<Index> patches;
    const double threshold = 0.5 * now.power;
    for (std::size_t i = 0; i < problem.patches(); ++i)
        if (unshot_power(state, problem, i) >= threshold) patches.push_back(static_cast<Index>(i));
    return patches;
}

bool is_large(const std::vector<Index>& patches, const FormFactorColumns& columns, double share) {
    std::uint64_t entries = 0;
    for (const Index i : patches) entries += columns.column_begin[i + 1] - columns.column_begin[i];
    return static_cast<double>(entries) >= share * static_cast<double>(columns.row.size());
}

/// Sends the unshot light of some patches along their columns.
void shoot_batch(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const std::vector<Index>& patches, const Context& context) {
    std::vector<Lanes> received(problem.patches());
    shoot(columns, patches, state.unshot, received, context);
    for (const Index i : patches) state.unshot[i] = Rgb(0);
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb irradiance = to_rgb(received[i]);
        state.irradiance[i] += irradiance;
        state.unshot[i] += problem.reflectance[i] * irradiance;
    }
    state.shots += patches.size();
}

/// Every patch shoots at once: H becomes F B + H0 afresh, which also forgets the rounding of earlier batches,
/// and what B gained by it is the new unshot light.
void sweep(ProgressiveState& state, const RadiosityProblem& problem, const Context& context) {
    const std::size_t patches = problem.patches();
    std::vector<Lanes> radiosity(patches);
    for (std::size_t i = 0; i < patches; ++i)
        radiosity[i] = to_lanes(problem.emission[i] + problem.reflectance[i] * state.irradiance[i]);
    std::vector<Lanes> received(patches);
    gather(problem.form_factors, radiosity, received, context);
    for (std::size_t i = 0; i < patches; ++i) {
        state.shots += state.unshot[i] != Rgb(0) ? 1 : 0;
        const Rgb irradiance = to_rgb(received[i]) + problem.external(i);
        state.unshot[i] = problem.reflectance[i] * (irradiance - state.irradiance[i]);
        state.irradiance[i] = irradiance;
    }
    ++state.sweeps;
}

/// Called after each polishing sweep. 1/(1 − g) of them shrink unshot light at least e-fold; where they do
/// not even halve it, rounding feeds it.
bool has_stalled(ProgressiveState& state, float unshot) {
    PolishingRun& run = state.run;
    if (run.sweeps > 0 && static_cast<double>(run.sweeps) * (1 - state.enclosure.gain) < 1) {
        ++run.sweeps;
        return false;
    }
    const bool stalled = run.sweeps > 0 && unshot > 0.5F * run.unshot_at_start;
    run = {1, unshot};
    return stalled;
}

/// Makes one batch and says where the solution then stands.
Survey make_batch(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                  const ProgressiveConfig& config, const Survey& before, const Context& context) {
    // Near the end only sweeps: each shrinks the largest unshot radiosity by the gain, so an end is certain.
    if (before.certificate.error_bound <= config.asked_error || before.only_rounding) state.polishing = true;
    bool swept = state.polishing;
    if (!swept) {
        const std::vector<Index> patches = choose(state, problem, before, config.order);
        swept =
            config.order == ShootingOrder::threshold_scan && is_large(patches, columns, config.sweep_share);
        if (!swept) shoot_batch(state, problem, columns, patches, context);
    }
    if (swept) sweep(state, problem, context);

    const Survey after = survey(state, problem);
    if (swept && after.certificate.error_bound <= config.asked_error) {
        state.status = ProgressiveStatus::converged;
    } else if (state.polishing && (after.only_rounding || has_stalled(state, after.unshot))) {
        state.status = ProgressiveStatus::exhausted;
    }
    return after;
}

/// Says how far the bound has come on its way to the asked one, on a logarithmic scale, since each batch
/// gains about the same factor.
class Reporter {
  public:
    Reporter(double asked, const Context& context) : asked_(asked), context_(context) {}

    void say(double bound) {
        if (!std::isfinite(bound) || bound <= 0) return context_.check_stop();
        if (first_ <= 0) first_ = bound;
        const double way = std::log(first_ / asked_);
        const double fraction = way > 0 ? std::log(first_ / bound) / way : 1;
        furthest_ = std::clamp(fraction, furthest_, 1.0);
        context_.report(furthest_, "shooting light");
    }

  private:
    double asked_;
    const Context& context_;
    double first_ = 0;
    double furthest_ = 0;
};

void check_step(const ProgressiveState& state, const RadiosityProblem& problem,
                const FormFactorColumns& columns, const ProgressiveConfig& config) {
    const std::size_t patches = problem.patches();
    if (!(config.asked_error > 0)) throw Error(ErrorKind::invalid_input, "asked error", "must be above 0");
    if (state.irradiance.size() != patches || state.unshot.size() != patches)
        throw Error(ErrorKind::invalid_input, "state", "belongs to another problem");
    if (columns.column_begin.size() != patches + 1 || columns.row.size() != problem.form_factors.entries())
        throw Error(ErrorKind::invalid_input, "form factor columns", "belong to another matrix");
}

}  // namespace

ProgressiveState make_progressive_state(const RadiosityProblem& problem, const Context& context) {
    check(problem);
    ProgressiveState state;
    state.enclosure = enclosure_of(problem, context);
    if (!(state.enclosure.gain < 1))
        throw Error(ErrorKind::cannot_converge, "reflectance",
                    "a patch reflects " + std::to_string(state.enclosure.gain) +
                        " of the light around it; at 1 or more the light would grow without bound");
    state.irradiance.reserve(problem.patches());
    state.unshot.reserve(problem.patches());
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        state.irradiance.push_back(problem.external(i));
        state.unshot.push_back(problem.emission[i] + problem.reflectance[i] * problem.external(i));
    }
    return state;
}

Certificate step(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const ProgressiveConfig& config, const Context& context) {
    check_step(state, problem, columns, config);
    Survey now = survey(state, problem);
    if (now.unshot == 0 && now.certificate.residual == 0) state.status = ProgressiveStatus::converged;
    const std::uint64_t shots_before = state.shots;
    Reporter reporter(config.asked_error, context);
    reporter.say(now.certificate.error_bound);
    while (state.status == ProgressiveStatus::running) {
        now = make_batch(state, problem, columns, config, now, context);
        reporter.say(now.certificate.error_bound);
        if (state.shots - shots_before >= config.max_shots) break;
    }
    return now.certificate;
}

ProgressiveSolution solve_progressive(const RadiosityProblem& problem, const FormFactorColumns& columns,
                                      const ProgressiveConfig& config, const Context& context) {
    ProgressiveSolution solution{make_progressive_state(problem, context), {}};
    solution.certificate = step(solution.state, problem, columns, config, context);
    return solution;
}

}  // namespace afterglow
