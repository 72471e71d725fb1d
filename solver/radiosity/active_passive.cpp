#include "solver/radiosity/active_passive.h"

#include <algorithm>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"
#include "solver/radiosity/potential.h"
#include "solver/radiosity/shooting.h"

namespace afterglow {

namespace {

/// Of the asked error, what each of two causes may take: light that active patches have not yet shot, and
/// light that is withheld from passive ones.
constexpr double half = 0.5;

void check_config(const ActivePassiveConfig& config) {
    if (!(config.asked_error > 0)) throw Error(ErrorKind::invalid_input, "asked error", "must be above 0");
    if (!(config.passive_share >= 0 && config.passive_share <= 1))
        throw Error(ErrorKind::invalid_input, "passive share", "must lie in [0, 1]");
    if (config.activations == 0) throw Error(ErrorKind::invalid_input, "activations", "must be 1 or more");
}

/// What a passive patch adds to the residual and to the unshot light.
struct Withheld {
    Index patch = 0;
    double residual = 0;  ///< |ρ (F B + H0 − H)| and its rounding, W/m²
    double unshot = 0;    ///< |ΔB|, W/m²

    [[nodiscard]] double largest(double gain) const { return std::max(residual, gain * unshot); }
};

std::vector<Withheld> find_withheld(const ActivePassiveState& state, const RadiosityProblem& problem,
                                    const Context& context) {
    std::vector<Index> passive;
    std::vector<Lanes> radiosity(problem.patches());
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        radiosity[i] = to_lanes(problem.emission[i] + problem.reflectance[i] * state.irradiance[i]);
        if (state.active[i] == 0) passive.push_back(static_cast<Index>(i));
    }
    std::vector<Lanes> received(passive.size());
    gather_rows(problem.form_factors, passive, radiosity, received, context);
    std::vector<Withheld> withheld;
    for (std::size_t k = 0; k < passive.size(); ++k) {
        const Index i = passive[k];
        const Rgb due = to_rgb(received[k]) + problem.external(i);
        Withheld here{i, 0, max_channel(glm::abs(state.unshot[i]))};
        for (int c = 0; c < 3; ++c) {
            const double missing = std::abs(static_cast<double>(due[c]) - state.irradiance[i][c]);
            const double rounding = gather_rounding * std::abs(static_cast<double>(due[c]));
            here.residual = std::max(here.residual, problem.reflectance[i][c] * (missing + rounding));
        }
        withheld.push_back(here);
    }
    return withheld;
}

/// The certificate of all patches.
Certificate certificate_of(const ActivePassiveState& state, const RadiosityProblem& problem,
                           const std::vector<Withheld>& withheld) {
    double unshot = 0;
    for (const Rgb& b : state.unshot)
        unshot = std::max(unshot, static_cast<double>(max_channel(glm::abs(b))));
    double residual = state.enclosure.gain * unshot + state.rounding;
    for (const Withheld& w : withheld) residual = std::max(residual, w.residual);
    return make_certificate(residual, state.enclosure.gain, mean_reflected(problem, state.irradiance));
}

/// Passive patches whose part of the error is more than they may have, most potential last.
std::vector<Index> to_activate(const ActivePassiveState& state, const RadiosityProblem& problem,
                               const std::vector<Withheld>& withheld, double asked_error) {
    const double gain = state.enclosure.gain;
    const double allowed = half * asked_error * (1 - gain) * mean_reflected(problem, state.irradiance);
    std::vector<Index> patches;
    for (const Withheld& w : withheld)
        if (w.largest(gain) > allowed) patches.push_back(w.patch);
    std::stable_sort(patches.begin(), patches.end(),
                     [&](Index a, Index b) { return state.potential[a] < state.potential[b]; });
    return patches;
}

/// With the light among active patches settled: activates the next ones. False if all is done.
bool activate_next(ActivePassiveState& state, const RadiosityProblem& problem,
                   const ActivePassiveConfig& config, const Context& context) {
    if (state.queue.empty()) {
        const std::vector<Withheld> withheld = find_withheld(state, problem, context);
        if (certificate_of(state, problem, withheld).error_bound <= config.asked_error) {
            state.status = ProgressiveStatus::converged;
            return false;
        }
        state.queue = to_activate(state, problem, withheld, config.asked_error);
        if (state.queue.empty()) {
            state.status = ProgressiveStatus::exhausted;
            return false;
        }
    }
    const std::size_t count = std::min(config.activations, state.queue.size());
    const std::vector<Index> next(state.queue.end() - static_cast<std::ptrdiff_t>(count), state.queue.end());
    activate(state, problem, next, context);
    state.queue.resize(state.queue.size() - count);
    return true;
}

void mark(ActivePassiveState& state, const RadiosityProblem& problem, const PatchRoles& roles,
          const ActivePassiveConfig& config, const Context& context) {
    state.potential = potential(problem, state.unshot, roles, context);
    std::vector<std::uint8_t> active = mark_active(state.potential, roles, config.passive_share);
    std::vector<Index> newly;
    for (std::size_t i = 0; i < active.size(); ++i) {
        if (active[i] != 0 && state.active[i] == 0) newly.push_back(static_cast<Index>(i));
        if (active[i] == 0) state.active[i] = 0;
    }
    state.seen.assign(roles.seen.begin(), roles.seen.end());
    state.queue.clear();
    activate(state, problem, newly, context);
}

}  // namespace

ActivePassiveState make_active_passive_state(const RadiosityProblem& problem, const PatchRoles& roles,
                                             const ActivePassiveConfig& config, const Context& context) {
    check_config(config);
    ActivePassiveState state{make_incremental_state(problem, context), {}, {}, {}, {}, 0};
    check(roles, problem.patches());
    state.potential = potential(problem, state.unshot, roles, context);
    state.active = mark_active(state.potential, roles, config.passive_share);
    state.seen.assign(roles.seen.begin(), roles.seen.end());
    return state;
}

void change(ActivePassiveState& state, const RadiosityProblem& problem, std::span<const Index> rows,
            const PatchRoles& roles, const ActivePassiveConfig& config, const Context& context) {
    check_config(config);
    check(roles, problem.patches());
    const bool changed = change_among(state, problem, rows, state.active, context);
    if (changed || !std::ranges::equal(state.seen, roles.seen)) mark(state, problem, roles, config, context);
}

void activate(ActivePassiveState& state, const RadiosityProblem& problem, std::span<const Index> patches,
              const Context& context) {
    std::vector<Index> passive;
    for (const Index i : patches)
        if (state.active[i] == 0) passive.push_back(i);
    if (passive.empty()) return;
    receive(state, problem, passive, context);
    for (const Index i : passive) state.active[i] = 1;
    state.activations += passive.size();
}

Certificate step(ActivePassiveState& state, const RadiosityProblem& problem, const FormFactorColumns& columns,
                 const PatchRoles& roles, const ActivePassiveConfig& config, const Context& context) {
    check_config(config);
    ProgressiveConfig shooting;
    shooting.asked_error = (config.goal == Goal::whole ? half : 1) * config.asked_error;
    shooting.order = config.order;
    shooting.sweep_share = config.sweep_share;
    shooting.finish = Finish::bound;
    shooting.roles = roles;
    check_step(state, problem, columns, shooting);

    const std::uint64_t shots_before = state.shots;
    double done = 0;
    while (state.status == ProgressiveStatus::running) {
        const std::uint64_t made = state.shots - shots_before;
        shooting.max_shots = config.max_shots > made ? config.max_shots - made : 0;
        // The first round has nearly all the light; later ones may be many.
        const double next = done + (1 - done) / 2;
        shoot_among(state, problem, columns, shooting, state.active, context.part(done, next));
        done = next;
        if (state.status == ProgressiveStatus::running || config.goal == Goal::active) break;
        if (activate_next(state, problem, config, context) && state.shots - shots_before >= config.max_shots)
            break;
    }
    return certificate_of(state, problem, find_withheld(state, problem, context));
}

ActivePassiveSolution solve_active_passive(const RadiosityProblem& problem, const FormFactorColumns& columns,
                                           const PatchRoles& roles, const ActivePassiveConfig& config,
                                           const Context& context) {
    ActivePassiveSolution solution{make_active_passive_state(problem, roles, config, context), {}};
    solution.certificate = step(solution.state, problem, columns, roles, config, context);
    return solution;
}

}  // namespace afterglow
