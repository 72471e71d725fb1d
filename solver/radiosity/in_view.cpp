#include "solver/radiosity/in_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/base/error.h"
#include "solver/radiosity/exchange.h"
#include "solver/radiosity/shooting.h"

namespace afterglow {

namespace {

constexpr std::size_t patches_per_chunk = 512;
// Of a bound: passes that gain less are not worth their time.
constexpr double least_gain = 0.01;
// Passes over all patches; each shrinks what is left of the first bound by the gain.
constexpr int most_passes = 200;
// Bounces of what is unshot that a bound follows patch by patch, each a pass over all rows.
constexpr int exact_bounces = 2;
// Sums of float shares are off by far less.
constexpr double slack = 1 + 1e-4;
// Bounces that weights follow. They decide only who shoots first.
constexpr int bounces_weighed = 8;
// Of what is allowed; where it takes more, all rows are gathered to forget it.
constexpr double most_rounding = 0.1;
// Of the largest weight.
constexpr double least_weight = 1e-3;
// Of the asked error that is aimed at, so that the bound seldom asks for another batch.
constexpr double aim = 0.9;

/// The largest value in each group.
std::vector<double> largest_by_group(const GroupedRows& rows, std::span<const double> by_patch) {
    std::vector<double> largest(rows.groups, 0.0);
    for (std::size_t i = 0; i < by_patch.size(); ++i)
        largest[rows.group[i]] = std::max(largest[rows.group[i]], by_patch[i]);
    return largest;
}

/// ρF of what each patch sends, and rounding.
std::vector<double> reflected_by_patch(const RadiosityProblem& problem, const std::vector<double>& sent,
                                       double rounding, const Context& context) {
    const FormFactorMatrix& matrix = problem.form_factors;
    std::vector<double> out(sent.size());
    context.for_chunks(sent.size(), patches_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            double sum = 0;
            for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e)
                sum += static_cast<double>(matrix.value[e]) * sent[matrix.column[e]];
            out[i] = slack * static_cast<double>(max_channel(problem.reflectance[i])) * sum + rounding;
        }
    });
    return out;
}

/// One pass: the largest of ρF v in each group, v given by group.
std::vector<double> spread(const GroupedRows& rows, std::span<const Rgb> reflectance,
                           const std::vector<double>& value, const Context& context) {
    const std::size_t patches = rows.group.size();
    std::vector<double> all(patches);
    context.for_chunks(patches, patches_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const float* const share = rows.share.data() + i * rows.groups;
            double sum = 0;
            for (std::size_t h = 0; h < rows.groups; ++h) sum += static_cast<double>(share[h]) * value[h];
            all[i] = static_cast<double>(max_channel(reflectance[i])) * sum;
        }
    });
    return largest_by_group(rows, all);
}

/// What light leaving each group does to each seen one, on average and over several bounces:
/// [seen][group].
std::vector<std::vector<double>> influence(const GroupedRows& rows, std::span<const Rgb> reflectance,
                                           std::span<const std::uint8_t> seen) {
    const std::size_t groups = rows.groups;
    std::vector<double> mean(groups * groups, 0.0), patches(groups, 0.0);
    for (std::size_t i = 0; i < rows.group.size(); ++i) {
        patches[rows.group[i]] += 1;
        for (std::size_t h = 0; h < groups; ++h)
            mean[rows.group[i] * groups + h] +=
                static_cast<double>(max_channel(reflectance[i]) * rows.share[i * groups + h]);
    }
    for (std::size_t g = 0; g < groups; ++g)
        for (std::size_t h = 0; h < groups; ++h) mean[g * groups + h] /= std::max(patches[g], 1.0);
    std::vector<std::vector<double>> all;
    for (std::size_t s = 0; s < groups; ++s) {
        if (seen[s] == 0) continue;
        std::vector<double> sum(groups, 0.0), now(groups, 0.0), next(groups);
        now[s] = 1;
        for (int bounce = 0; bounce < bounces_weighed; ++bounce) {
            std::fill(next.begin(), next.end(), 0.0);
            for (std::size_t g = 0; g < groups; ++g)
                if (now[g] > 0)
                    for (std::size_t h = 0; h < groups; ++h) next[h] += now[g] * mean[g * groups + h];
            for (std::size_t h = 0; h < groups; ++h) sum[h] += next[h];
            std::swap(now, next);
        }
        all.push_back(std::move(sum));
    }
    return all;
}

/// How much unshot light each group may keep, W/m², for what it does to the view to come to 1 at most: as if
/// each did the same, since a group that must keep less costs about as much for every factor of two.
std::vector<double> allowed_by_group(const GroupedRows& rows, std::span<const Rgb> reflectance,
                                     std::span<const std::uint8_t> seen) {
    const auto by_seen = influence(rows, reflectance, seen);
    std::vector<double> weight(rows.groups, 0.0);
    for (const auto& one : by_seen)
        for (std::size_t h = 0; h < weight.size(); ++h) weight[h] = std::max(weight[h], one[h]);
    const double most = weight.empty() ? 0 : *std::max_element(weight.begin(), weight.end());
    // What only ways of more bounces connect counts a little, so that it does not wait for ever.
    for (double& w : weight) w = std::max(w, least_weight * most);
    double together = 0;
    for (const auto& one : by_seen) {
        double sum = 0;
        for (std::size_t h = 0; h < weight.size(); ++h)
            if (weight[h] > 0) sum += one[h] / weight[h];
        together = std::max(together, sum);
    }
    std::vector<double> allowed(rows.groups, std::numeric_limits<double>::infinity());
    for (std::size_t h = 0; h < weight.size(); ++h)
        if (weight[h] > 0) allowed[h] = 1 / (together * weight[h]);
    return allowed;
}

/// Patches that keep more than `scale` times what they may, those with most power among them.
std::vector<Index> next_batch(const ProgressiveState& state, const RadiosityProblem& problem,
                              const GroupedRows& rows, const std::vector<double>& allowed, double scale,
                              double batch_share) {
    std::vector<double> power(rows.group.size(), 0.0);
    double largest = 0;
    for (std::size_t i = 0; i < power.size(); ++i) {
        const auto light = static_cast<double>(max_channel(glm::abs(state.unshot[i])));
        if (light <= scale * allowed[rows.group[i]]) continue;
        power[i] = light * static_cast<double>(problem.area[i]);
        largest = std::max(largest, power[i]);
    }
    std::vector<Index> patches;
    for (std::size_t i = 0; i < power.size(); ++i)
        if (power[i] > 0 && power[i] >= batch_share * largest) patches.push_back(static_cast<Index>(i));
    return patches;
}

/// What rounding is at its best, in ρH.
double least_rounding(const ProgressiveState& state, const RadiosityProblem& problem) {
    float reflected = 0;
    for (std::size_t i = 0; i < problem.patches(); ++i)
        reflected = std::max(reflected, max_channel(glm::abs(problem.reflectance[i] * state.irradiance[i])));
    return gather_rounding * static_cast<double>(reflected);
}

}  // namespace

GroupedRows group_rows(const FormFactorMatrix& matrix, std::vector<Index> group, const Context& context) {
    if (group.size() != matrix.rows())
        throw Error(ErrorKind::invalid_input, "groups", "need one number a patch");
    GroupedRows rows;
    rows.groups = group.empty() ? 0 : *std::max_element(group.begin(), group.end()) + std::size_t{1};
    rows.group = std::move(group);
    rows.share.assign(rows.group.size() * rows.groups, 0.0F);
    context.for_chunks(matrix.rows(), patches_per_chunk, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            float* const share = rows.share.data() + i * rows.groups;
            for (std::uint64_t e = matrix.row_begin[i]; e < matrix.row_begin[i + 1]; ++e)
                share[rows.group[matrix.column[e]]] += matrix.value[e];
        }
    });
    return rows;
}

std::vector<Index> groups_of_neighbours(std::span<const Vec3> centres, std::size_t groups) {
    std::vector<Index> order(centres.size()), group(centres.size(), 0);
    std::iota(order.begin(), order.end(), Index{0});
    // Parts of `order`; the largest is halved next.
    struct Part {
        std::size_t begin, end;
    };
    std::vector<Part> parts{{0, centres.size()}};
    while (parts.size() < std::min(groups, centres.size())) {
        const auto largest = std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
            return a.end - a.begin < b.end - b.begin;
        });
        Box box;
        for (std::size_t k = largest->begin; k < largest->end; ++k) box.add(centres[order[k]]);
        const Vec3 extent = box.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const Part part = *largest;
        const std::size_t middle = part.begin + (part.end - part.begin) / 2;
        const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(part.begin), at(middle), at(part.end), [&](Index a, Index b) {
            return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
        });
        largest->end = middle;
        parts.push_back({middle, part.end});
    }
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (std::size_t k = parts[p].begin; k < parts[p].end; ++k) group[order[k]] = static_cast<Index>(p);
    return group;
}

double error_in_view(const ProgressiveState& state, const RadiosityProblem& problem, const GroupedRows& rows,
                     std::span<const std::uint8_t> seen, double enough, const Context& context) {
    // Of what is unshot, and of what that leaves unshot in its turn, exactly by patch; the rest by group.
    std::vector<double> known(problem.patches(), 0.0), sent(problem.patches());
    for (std::size_t i = 0; i < sent.size(); ++i)
        sent[i] = static_cast<double>(max_channel(glm::abs(state.unshot[i])));
    for (int bounce = 0; bounce < exact_bounces; ++bounce) {
        sent = reflected_by_patch(problem, sent, state.rounding, context);
        for (std::size_t i = 0; i < sent.size(); ++i) known[i] += sent[i];
    }
    const double g = state.enclosure.gain;
    const std::vector<double> last = largest_by_group(rows, sent), all_known = largest_by_group(rows, known);
    const double most = last.empty() ? 0 : *std::max_element(last.begin(), last.end());
    // What is not known yet: first by the gain alone, then ever less.
    std::vector<double> rest(rows.groups, slack * (g * most + state.rounding) / (1 - g));
    const auto bound = [&] {
        double largest = 0;
        for (std::size_t h = 0; h < rows.groups; ++h)
            if (seen[h] != 0) largest = std::max(largest, all_known[h] + rest[h]);
        return largest;
    };
    for (int pass = 0; pass < most_passes && bound() > enough; ++pass) {
        context.check_stop();
        std::vector<double> from(rows.groups);
        for (std::size_t h = 0; h < rows.groups; ++h) from[h] = last[h] + rest[h];
        const std::vector<double> next = spread(rows, problem.reflectance, from, context);
        bool falls = false;
        for (std::size_t h = 0; h < rows.groups; ++h) {
            const double less = std::min(rest[h], slack * next[h] + state.rounding);
            if (less < (1 - least_gain) * rest[h]) falls = true;
            rest[h] = less;
        }
        if (!falls) break;
    }
    return bound();
}

Certificate step_in_view(IncrementalState& state, const RadiosityProblem& problem,
                         const FormFactorColumns& columns, const GroupedRows& rows,
                         std::span<const std::uint8_t> seen, const InViewConfig& config,
                         const Context& context) {
    ProgressiveConfig shooting;
    shooting.asked_error = config.asked_error;
    shooting.batch_share = config.batch_share;
    check_step(state, problem, columns, shooting);
    if (rows.group.size() != problem.patches() || seen.size() != rows.groups)
        throw Error(ErrorKind::invalid_input, "groups", "belong to another problem");
    const std::vector<double> allowed_unshot = allowed_by_group(rows, problem.reflectance, seen);
    const double g = state.enclosure.gain;
    double target = aim;
    bool has_shot = false;  // since all rows were gathered
    for (;;) {
        context.check_stop();
        const double reflected = mean_reflected(problem, state.irradiance);
        const double allowed = config.asked_error * reflected, rounding = state.rounding / (1 - g);
        // Only where that leaves room for more batches.
        if (has_shot && rounding > most_rounding * allowed &&
            4 * least_rounding(state, problem) / (1 - g) < most_rounding * allowed) {
            refresh(state, problem, context);
            has_shot = false;
            continue;
        }
        // Below its rounding no solution need go.
        const double scale = std::max(target * (allowed - rounding), 0.5 * rounding);
        const std::vector<Index> next =
            next_batch(state, problem, rows, allowed_unshot, scale, config.batch_share);
        if (next.empty()) {
            const double error = error_in_view(state, problem, rows, seen, allowed, context);
            const bool is_met = error <= allowed, stuck = scale <= rounding;
            state.status = is_met ? ProgressiveStatus::converged : ProgressiveStatus::exhausted;
            if (is_met || stuck) return make_certificate(error * (1 - g), g, reflected);
            // The bound takes the worst of each group where what is allowed takes the mean.
            target *= std::clamp(allowed / error, 0.3, 0.9);
            continue;
        }
        shoot_at_once(state, problem, columns, next, context);
        has_shot = true;
    }
}

}  // namespace afterglow
