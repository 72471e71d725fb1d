#include "solver/radiosity/shooting.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"

namespace afterglow {

namespace {

using Active = std::span<const std::uint8_t>;

float largest_magnitude(const Rgb& c) {
    return max_channel(glm::abs(c));
}

bool takes_part(const Active& active, std::size_t patch) {
    return active.empty() || active[patch] != 0;
}

/// Where a solution stands; a function of the state alone.
struct Survey {
    float unshot = 0;     ///< largest |ΔB|, W/m²
    float reflected = 0;  ///< largest ρH, W/m²
    double mean = 0;      ///< mean_reflected
    Certificate certificate;
    bool only_rounding = false;  ///< what is left unshot is far less than what rounding hides
};

Survey survey(const ProgressiveState& state, const RadiosityProblem& problem, const Active& active) {
    Survey result;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        if (!takes_part(active, i)) continue;
        result.unshot = std::max(result.unshot, largest_magnitude(state.unshot[i]));
        result.reflected =
            std::max(result.reflected, largest_magnitude(problem.reflectance[i] * state.irradiance[i]));
    }
    const double left = state.enclosure.gain * static_cast<double>(result.unshot);
    result.mean = mean_reflected(problem, state.irradiance);
    result.certificate = make_certificate(left + state.rounding, state.enclosure.gain, result.mean);
    result.only_rounding = 8 * left <= state.rounding;
    return result;
}

bool is_large(const std::vector<Index>& patches, const FormFactorColumns& columns, double share) {
    std::uint64_t entries = 0;
    for (const Index i : patches) entries += columns.column_begin[i + 1] - columns.column_begin[i];
    return static_cast<double>(entries) >= share * static_cast<double>(columns.row.size());
}

/// What a batch adds to the bound of ρ |H − F (B − ΔB) − H0|: sums of `patches` products in single precision,
/// their additions to H and ΔB, and what a wrong B sends out in its turn.
double rounding_of(std::size_t patches, double gain, double shot, double reflected, double unshot) {
    constexpr double unit = 0x1p-24;
    const double sums = static_cast<double>(patches + 1) * gain * shot;
    return unit * ((1 + gain) * (sums + reflected) + gain * (gain * shot + unshot));
}

/// Light below this share of the brightest is none. Where all that was reflected is taken away, sweeps would
/// else chase what rounding left of it into the smallest numbers, with nothing to measure it by.
constexpr float darkness = 1e-20F;

float darkest_light(const RadiosityProblem& problem) {
    float brightest = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i)
        brightest = std::max(brightest, max_channel(problem.emission[i] + problem.external(i)));
    return darkness * brightest;
}

Rgb without_darkness(const Rgb& irradiance, float least) {
    return {std::abs(irradiance.r) < least ? 0 : irradiance.r,
            std::abs(irradiance.g) < least ? 0 : irradiance.g,
            std::abs(irradiance.b) < least ? 0 : irradiance.b};
}

/// Sends the unshot light of some patches along their columns.
void shoot_batch(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const std::vector<Index>& patches, const Active& active, float darkest,
                 const Context& context) {
    std::vector<Lanes> received(problem.patches());
    if (active.empty()) {
        shoot(columns, patches, state.unshot, received, context);
        for (const Index i : patches) state.entries += columns.column_begin[i + 1] - columns.column_begin[i];
    } else {
        state.entries += shoot_to_active(columns, patches, state.unshot, active, received, context);
    }
    float shot = 0;
    for (const Index i : patches) {
        shot = std::max(shot, largest_magnitude(state.unshot[i]));
        state.unshot[i] = Rgb(0);
    }
    float reflected = 0;
    float unshot = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        if (!takes_part(active, i)) continue;
        const Rgb irradiance = to_rgb(received[i]);
        state.irradiance[i] = without_darkness(state.irradiance[i] + irradiance, darkest);
        state.unshot[i] += problem.reflectance[i] * irradiance;
        reflected = std::max(reflected, largest_magnitude(problem.reflectance[i] * state.irradiance[i]));
        unshot = std::max(unshot, largest_magnitude(state.unshot[i]));
    }
    state.rounding += rounding_of(patches.size(), state.enclosure.gain, shot, reflected, unshot);
    state.shots += patches.size();
}

/// Every patch that takes part shoots at once: its H becomes F B + H0 afresh, which also forgets the rounding
/// of earlier batches, and what B gained by it is the new unshot light. Of the others arrives what they have
/// shot before.
void sweep(ProgressiveState& state, const RadiosityProblem& problem, const Active& active, float darkest,
           const Context& context) {
    const std::size_t patches = problem.patches();
    std::vector<Lanes> radiosity(patches);
    std::vector<Index> receivers;
    for (std::size_t i = 0; i < patches; ++i) {
        Rgb light = problem.emission[i] + problem.reflectance[i] * state.irradiance[i];
        if (takes_part(active, i))
            receivers.push_back(static_cast<Index>(i));
        else
            light -= state.unshot[i];
        radiosity[i] = to_lanes(light);
    }
    std::vector<Lanes> received(receivers.size());
    gather_rows(problem.form_factors, receivers, radiosity, received, context);
    float reflected = 0;
    for (std::size_t k = 0; k < receivers.size(); ++k) {
        const Index i = receivers[k];
        state.shots += state.unshot[i] != Rgb(0) ? 1 : 0;
        state.entries += problem.form_factors.row_begin[i + 1] - problem.form_factors.row_begin[i];
        const Rgb irradiance = without_darkness(to_rgb(received[k]) + problem.external(i), darkest);
        state.unshot[i] = problem.reflectance[i] * (irradiance - state.irradiance[i]);
        state.irradiance[i] = irradiance;
        reflected = std::max(reflected, largest_magnitude(problem.reflectance[i] * irradiance));
    }
    state.rounding = gather_rounding * static_cast<double>(reflected);
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

/// Where rounding takes a tenth of the promise, and a sweep would forget most of it.
bool is_rounding_heavy(const ProgressiveState& state, const Survey& now, double asked_error) {
    const double promise = asked_error * (1 - state.enclosure.gain) * now.mean;
    return state.rounding > 0.1 * promise &&
           state.rounding > 2 * gather_rounding * static_cast<double>(now.reflected);
}

/// Unshot light, W/m², that a patch may keep: with no more anywhere, the bound is met. Somewhat less, so that
/// it does not waver with a mean that still falls and with rounding that grows: what was little enough once
/// stays where it is, and a room in which nothing changes stays as it was.
float allowed_unshot(const ProgressiveState& state, const Survey& now, double asked_error) {
    const double gain = state.enclosure.gain;
    const double promise = asked_error * (1 - gain) * now.mean;
    const double unshot = std::min(0.8 * promise, 0.9 * (promise - state.rounding));
    return gain > 0 ? static_cast<float>(std::max(unshot, 0.0) / gain) : 0;
}

/// One run of batches under one configuration.
struct Shooting {
    const RadiosityProblem& problem;
    const FormFactorColumns& columns;
    const ProgressiveConfig& config;
    Active active;
    ShooterChoice choice;
    float darkest;  ///< see darkness
    const Context& context;

    [[nodiscard]] bool is_met(const Survey& now) const {
        return now.certificate.error_bound <= config.asked_error;
    }
    Survey make_batch(ProgressiveState& state, const Survey& before) const;
};

/// Makes one batch and says where the solution then stands.
Survey Shooting::make_batch(ProgressiveState& state, const Survey& before) const {
    // Near the end only sweeps: each shrinks the largest unshot radiosity by the gain, so an end is certain.
    if ((config.finish == Finish::sweep && is_met(before)) || before.only_rounding) state.polishing = true;
    bool swept = state.polishing || is_rounding_heavy(state, before, config.asked_error);
    if (!swept) {
        const float least =
            config.finish == Finish::bound ? allowed_unshot(state, before, config.asked_error) : 0;
        const std::vector<Index> patches = choice.next(state.unshot, active, least, config.batch_share);
        swept = patches.empty() || (config.order != ShootingOrder::largest_first &&
                                    is_large(patches, columns, config.sweep_share));
        if (!swept) shoot_batch(state, problem, columns, patches, active, darkest, context);
    }
    if (swept) sweep(state, problem, active, darkest, context);

    const Survey after = survey(state, problem, active);
    if (is_met(after) && (swept || config.finish == Finish::bound)) {
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

}  // namespace

Certificate shoot_among(ProgressiveState& state, const RadiosityProblem& problem,
                        const FormFactorColumns& columns, const ProgressiveConfig& config,
                        std::span<const std::uint8_t> active, const Context& context) {
    Survey now = survey(state, problem, active);
    const bool nothing_left = now.unshot == 0 && now.certificate.residual == 0;
    const bool met = config.finish == Finish::bound && now.certificate.error_bound <= config.asked_error;
    if (nothing_left || (met && state.status == ProgressiveStatus::running))
        state.status = ProgressiveStatus::converged;
    const std::uint64_t shots_before = state.shots;
    const Shooting shooting{
        problem, columns, config, active, {config.order, problem, config.roles}, darkest_light(problem),
        context};
    Reporter reporter(config.asked_error, context);
    reporter.say(now.certificate.error_bound);
    while (state.status == ProgressiveStatus::running) {
        now = shooting.make_batch(state, now);
        reporter.say(now.certificate.error_bound);
        if (state.shots - shots_before >= config.max_shots) break;
    }
    return now.certificate;
}

void shoot_at_once(ProgressiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                   const std::vector<Index>& patches, const Context& context) {
    std::vector<DoubleLanes> received(problem.patches());
    float shot = 0;
    for (const Index i : patches) {
        context.check_stop();
        const DoubleLanes::Vector light = to_double(to_lanes(state.unshot[i])).v;
        for (std::uint64_t e = columns.column_begin[i]; e < columns.column_begin[i + 1]; ++e)
            received[columns.row[e]].v += static_cast<double>(columns.value[e]) * light;
        state.entries += columns.column_begin[i + 1] - columns.column_begin[i];
    }
    const float darkest = darkest_light(problem);
    for (const Index i : patches) {
        shot = std::max(shot, largest_magnitude(state.unshot[i]));
        state.unshot[i] = Rgb(0);
    }
    float reflected = 0, unshot = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb irradiance = to_rgb({__builtin_convertvector(received[i].v, Lanes::Vector)});
        state.irradiance[i] = without_darkness(state.irradiance[i] + irradiance, darkest);
        state.unshot[i] += problem.reflectance[i] * irradiance;
        reflected = std::max(reflected, largest_magnitude(problem.reflectance[i] * state.irradiance[i]));
        unshot = std::max(unshot, largest_magnitude(state.unshot[i]));
    }
    // Sums in double are rounded once, however many shoot.
    state.rounding += rounding_of(1, state.enclosure.gain, shot, reflected, unshot);
    state.shots += patches.size();
    state.status = ProgressiveStatus::running;
}

void check_step(const ProgressiveState& state, const RadiosityProblem& problem,
                const FormFactorColumns& columns, const ProgressiveConfig& config) {
    const std::size_t patches = problem.patches();
    if (!(config.asked_error > 0)) throw Error(ErrorKind::invalid_input, "asked error", "must be above 0");
    if (!(config.batch_share > 0 && config.batch_share <= 1))
        throw Error(ErrorKind::invalid_input, "batch share", "must be above 0, at most 1");
    if (state.irradiance.size() != patches || state.unshot.size() != patches)
        throw Error(ErrorKind::invalid_input, "state", "belongs to another problem");
    if (columns.column_begin.size() != patches + 1 || columns.row.size() != problem.form_factors.entries())
        throw Error(ErrorKind::invalid_input, "form factor columns", "belong to another matrix");
    check(config.roles, patches);
}

void check_gain(const Enclosure& enclosure) {
    if (!(enclosure.gain < 1))
        throw Error(ErrorKind::cannot_converge, "reflectance",
                    "a patch reflects " + std::to_string(enclosure.gain) +
                        " of the light around it; at 1 or more the light would grow without bound");
}

}  // namespace afterglow
