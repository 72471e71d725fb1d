#include "solver/radiosity/incremental.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"
#include "solver/radiosity/shooting.h"

namespace afterglow {

namespace {

using Exact = glm::dvec3;

std::vector<Rgb> copy_of(std::span<const Rgb> values) {
    return {values.begin(), values.end()};
}

Exact radiosity(const Rgb& emission, const Rgb& reflectance, const Rgb& irradiance) {
    return Exact(emission) + Exact(reflectance) * Exact(irradiance);
}

bool grew(const Rgb& before, const Rgb& after) {
    return after.r > before.r || after.g > before.g || after.b > before.b;
}

/// What all that was shot, S = B − ΔB, brings along some rows of a matrix.
std::vector<Lanes> gather_shot(const IncrementalState& state, const FormFactorMatrix& matrix,
                               std::span<const Index> rows, const Context& context) {
    std::vector<Lanes> received(rows.size());
    if (rows.empty()) return received;
    std::vector<Lanes> shot(state.irradiance.size());
    for (std::size_t i = 0; i < shot.size(); ++i)
        shot[i] = to_lanes(Rgb(radiosity(state.emission[i], state.reflectance[i], state.irradiance[i]) -
                               Exact(state.unshot[i])));
    gather_rows(matrix, rows, shot, received, context);
    return received;
}

/// What a new irradiance and a new unshot light may have lost to rounding, in ρH.
double lost(const Rgb& reflectance, const Rgb& irradiance, const Rgb& unshot) {
    const float reflected = max_channel(glm::abs(reflectance * irradiance));
    return gather_rounding * static_cast<double>(std::max(reflected, max_channel(glm::abs(unshot))));
}

/// Patches that gather afresh: those whose rows changed and those whose rounding was counted at a smaller ρ.
std::vector<Index> rows_to_set(const IncrementalState& state, const RadiosityProblem& problem,
                               std::span<const Index> rows, std::span<const std::uint8_t> active) {
    std::vector<Index> set;
    const auto add = [&](Index i) {
        if (active.empty() || active[i] != 0) set.push_back(i);
    };
    for (const Index i : rows) add(i);
    for (std::size_t i = 0; i < problem.patches(); ++i)
        if (grew(state.reflectance[i], problem.reflectance[i])) add(static_cast<Index>(i));
    return set;
}

/// The irradiance that what was shot so far brings to the changed surfaces.
std::vector<Rgb> changed_irradiance(const IncrementalState& state, const RadiosityProblem& problem,
                                    std::span<const Index> set, const Context& context) {
    const std::vector<Lanes> received = gather_shot(state, problem.form_factors, set, context);
    std::vector<Rgb> irradiance = state.irradiance;
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        if (problem.external(i) != state.external_irradiance[i])
            irradiance[i] += problem.external(i) - state.external_irradiance[i];
    for (std::size_t k = 0; k < set.size(); ++k)
        irradiance[set[k]] = to_rgb(received[k]) + problem.external(set[k]);
    return irradiance;
}

/// Puts out what is left of channels in which nothing shines: else sweeps would chase rounding into the
/// smallest numbers, since there is no light to measure it by.
void darken(IncrementalState& state, const RadiosityProblem& problem) {
    Rgb light(0);
    for (std::size_t i = 0; i < problem.patches(); ++i)
        light = glm::max(light, problem.emission[i] + problem.external(i));
    for (int c = 0; c < 3; ++c) {
        if (light[c] > 0) continue;
        for (Rgb& h : state.irradiance) h[c] = 0;
        for (Rgb& b : state.unshot) b[c] = 0;
    }
    if (light == Rgb(0)) state.rounding = 0;
}

void check_rows(std::span<const Index> rows, std::size_t patches) {
    for (const Index i : rows)
        if (i >= patches)
            throw Error(ErrorKind::invalid_input, "changed rows",
                        "name patch " + std::to_string(i) + " of " + std::to_string(patches));
}

/// Takes over irradiance and attributes; false if that changed nothing.
bool take_over(IncrementalState& state, const RadiosityProblem& problem, const std::vector<Rgb>& irradiance) {
    bool differs = false;
    double rounding = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb& emission = problem.emission[i];
        const Rgb& reflectance = problem.reflectance[i];
        if (irradiance[i] == state.irradiance[i] && emission == state.emission[i] &&
            reflectance == state.reflectance[i])
            continue;
        differs = true;
        // In double: both radiosities may be large and their difference small.
        state.unshot[i] = Rgb(Exact(state.unshot[i]) + radiosity(emission, reflectance, irradiance[i]) -
                              radiosity(state.emission[i], state.reflectance[i], state.irradiance[i]));
        state.irradiance[i] = irradiance[i];
        state.emission[i] = emission;
        state.reflectance[i] = reflectance;
        rounding = std::max(rounding, lost(reflectance, irradiance[i], state.unshot[i]));
    }
    for (std::size_t i = 0; i < problem.patches(); ++i) state.external_irradiance[i] = problem.external(i);
    state.rounding += rounding;
    return differs;
}

void resume(IncrementalState& state) {
    state.status = ProgressiveStatus::running;
    state.polishing = false;
    state.run = {};
}

}  // namespace

ProgressiveConfig following_config(double asked_error) {
    ProgressiveConfig config;
    config.asked_error = asked_error;
    config.finish = Finish::bound;
    config.batch_share = 1.0 / 16;
    return config;
}

IncrementalState make_incremental_state(const RadiosityProblem& problem, const Context& context) {
    IncrementalState state{make_progressive_state(problem, context), copy_of(problem.emission),
                           copy_of(problem.reflectance), std::vector<Rgb>(problem.patches()),
                           row_sums(problem.form_factors, context)};
    for (std::size_t i = 0; i < problem.patches(); ++i) state.external_irradiance[i] = problem.external(i);
    return state;
}

std::vector<Index> changed_rows(const FormFactorMatrix& before, const FormFactorMatrix& after,
                                const Context& context) {
    if (before.rows() != after.rows())
        throw Error(ErrorKind::invalid_input, "form factors", "of another number of patches");
    constexpr std::size_t chunk = 256;
    std::vector<std::uint8_t> differs(after.rows());
    context.for_chunks(after.rows(), chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto at = static_cast<std::ptrdiff_t>(before.row_begin[i]);
            const auto end = static_cast<std::ptrdiff_t>(before.row_begin[i + 1]);
            const auto new_at = static_cast<std::ptrdiff_t>(after.row_begin[i]);
            const auto new_end = static_cast<std::ptrdiff_t>(after.row_begin[i + 1]);
            const auto same = [&](const auto& old_values, const auto& new_values) {
                return std::equal(old_values.begin() + at, old_values.begin() + end,
                                  new_values.begin() + new_at, new_values.begin() + new_end);
            };
            differs[i] = same(before.column, after.column) && same(before.value, after.value) ? 0 : 1;
        }
    });
    std::vector<Index> rows;
    for (std::size_t i = 0; i < differs.size(); ++i)
        if (differs[i] != 0) rows.push_back(static_cast<Index>(i));
    return rows;
}

void change(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> rows,
            const Context& context) {
    change_among(state, problem, rows, {}, context);
}

bool change_among(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> rows,
                  std::span<const std::uint8_t> active, const Context& context) {
    check(problem);
    if (state.irradiance.size() != problem.patches())
        throw Error(ErrorKind::invalid_input, "state", "belongs to another number of patches");
    check_rows(rows, problem.patches());
    std::vector<double> row_sum = state.row_sum;
    const std::vector<double> new_sums = row_sums(problem.form_factors, rows, context);
    for (std::size_t k = 0; k < rows.size(); ++k) row_sum[rows[k]] = new_sums[k];
    const Enclosure enclosure = enclosure_of(problem, row_sum);
    check_gain(enclosure);
    const std::vector<Index> set = rows_to_set(state, problem, rows, active);
    const std::vector<Rgb> irradiance = changed_irradiance(state, problem, set, context);

    // Nothing below can fail.
    state.row_sum = std::move(row_sum);
    state.enclosure = enclosure;
    const bool differs = take_over(state, problem, irradiance);
    if (!differs && rows.empty()) return false;
    darken(state, problem);
    resume(state);
    return true;
}

void refresh(IncrementalState& state, const RadiosityProblem& problem, const Context& context) {
    std::vector<Index> all(problem.patches());
    std::iota(all.begin(), all.end(), Index{0});
    const double before = std::exchange(state.rounding, 0.0);
    try {
        receive(state, problem, all, context);
    } catch (...) {
        state.rounding = before;
        throw;
    }
}

void receive(IncrementalState& state, const RadiosityProblem& problem, std::span<const Index> patches,
             const Context& context) {
    const std::vector<Lanes> received = gather_shot(state, problem.form_factors, patches, context);
    double rounding = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
        const Index i = patches[k];
        const Rgb irradiance = to_rgb(received[k]) + problem.external(i);
        state.unshot[i] += problem.reflectance[i] * (irradiance - state.irradiance[i]);
        state.irradiance[i] = irradiance;
        state.entries += problem.form_factors.row_begin[i + 1] - problem.form_factors.row_begin[i];
        rounding = std::max(rounding, lost(problem.reflectance[i], irradiance, state.unshot[i]));
    }
    state.rounding += rounding;
    resume(state);
}

}  // namespace afterglow
