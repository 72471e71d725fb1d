#include "solver/radiosity/potential.h"

#include <algorithm>
#include <numeric>

#include "solver/radiosity/exchange.h"

namespace afterglow {

namespace {

/// Means over all area, per channel.
struct Means {
    Rgb ambient{0};  ///< Cohen's estimate of what arrives, from |ΔB|
    float reflectance = 0;
    float seen = 0;  ///< share of the area
};

Means means_of(const RadiosityProblem& problem, std::span<const Rgb> unshot, const PatchRoles& roles) {
    double area = 0;
    double seen = 0;
    glm::dvec3 light(0);
    glm::dvec3 reflectance(0);
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const double a = problem.area[i];
        area += a;
        if (roles.is_seen(i)) seen += a;
        light += a * glm::dvec3(glm::abs(unshot[i]));
        reflectance += a * glm::dvec3(problem.reflectance[i]);
    }
    if (area <= 0) return {};
    reflectance /= area;
    Means means;
    for (int c = 0; c < 3; ++c)
        means.ambient[c] = static_cast<float>(light[c] / area / (1 - std::min(reflectance[c], 0.99)));
    means.reflectance = max_channel(Rgb(reflectance));
    means.seen = static_cast<float>(seen / area);
    return means;
}

/// Share of its light that each patch sends to seen ones, for the patches listed.
std::vector<Lanes> shares_to_seen(const RadiosityProblem& problem, const PatchRoles& roles,
                                  std::span<const Index> patches, const Context& context) {
    std::vector<Lanes> is_seen(problem.patches());
    for (std::size_t i = 0; i < problem.patches(); ++i) is_seen[i] = to_lanes(Rgb(roles.is_seen(i) ? 1 : 0));
    std::vector<Lanes> shares(patches.size());
    gather_rows(problem.form_factors, patches, is_seen, shares, context);
    return shares;
}

/// Patches that stand or fall together.
struct Group {
    double potential = 0;
    std::size_t patches = 0;
    bool hidden = true;  ///< all of it, and active so far
};

std::size_t group_of(std::span<const Index> numbers, std::size_t patch) {
    return numbers.empty() ? patch : numbers[patch];
}

/// Makes hidden groups passive, those with the least potential a patch first, while `left` W may go.
void cull(std::vector<std::uint8_t>& active, std::span<const double> potential, const PatchRoles& roles,
          std::span<const Index> numbers, double& left) {
    std::vector<Group> groups(active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
        Group& group = groups[group_of(numbers, i)];
        if (active[i] == 0) continue;
        group.potential += potential[i];
        ++group.patches;
        group.hidden = group.hidden && !roles.is_seen(i);
    }
    std::vector<Index> order;
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (groups[g].hidden && groups[g].patches > 0) order.push_back(static_cast<Index>(g));
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
        return groups[a].potential * static_cast<double>(groups[b].patches) <
               groups[b].potential * static_cast<double>(groups[a].patches);
    });
    std::vector<std::uint8_t> goes(groups.size());
    for (const Index g : order) {
        if (groups[g].potential > left) continue;
        left -= groups[g].potential;
        goes[g] = 1;
    }
    for (std::size_t i = 0; i < active.size(); ++i)
        if (goes[group_of(numbers, i)] != 0) active[i] = 0;
}

}  // namespace

std::vector<double> potential(const RadiosityProblem& problem, std::span<const Rgb> unshot,
                              const PatchRoles& roles, const Context& context) {
    const Means means = means_of(problem, unshot, roles);
    std::vector<double> power(problem.patches());
    std::vector<Index> hidden;
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        const Rgb light = glm::abs(unshot[i]) + problem.reflectance[i] * means.ambient;
        power[i] = static_cast<double>(max_channel(light)) * problem.area[i];
        if (!roles.is_seen(i)) hidden.push_back(static_cast<Index>(i));
    }
    const std::vector<Lanes> shares = shares_to_seen(problem, roles, hidden, context);
    for (std::size_t k = 0; k < hidden.size(); ++k) {
        const float direct = std::min(to_rgb(shares[k]).r, 1.0F);
        power[hidden[k]] *= static_cast<double>(direct + (1 - direct) * means.reflectance * means.seen);
    }
    return power;
}

std::vector<std::uint8_t> mark_active(std::span<const double> potential, const PatchRoles& roles,
                                      double passive_share) {
    std::vector<std::uint8_t> active(potential.size(), 1);
    if (roles.seen.empty()) return active;
    double left = passive_share * std::accumulate(potential.begin(), potential.end(), 0.0);
    if (!roles.object.empty()) cull(active, potential, roles, roles.object, left);
    cull(active, potential, roles, roles.surface, left);
    return active;
}

}  // namespace afterglow
