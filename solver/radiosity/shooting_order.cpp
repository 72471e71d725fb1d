#include "solver/radiosity/shooting_order.h"

#include <algorithm>

namespace afterglow {

namespace {

/// From here on a patch is highly reflectant.
constexpr float high_reflectance = 0.5F;

}  // namespace

ShooterChoice::ShooterChoice(ShootingOrder order, const RadiosityProblem& problem, const PatchRoles& roles)
    : order_(order), problem_(problem), roles_(roles) {
    if (order != ShootingOrder::estimated) return;
    double area = 0;
    double reflected[3] = {0, 0, 0};
    for (std::size_t i = 0; i < problem.patches(); ++i) {
        area += problem.area[i];
        if (!roles.is_seen(i)) continue;
        for (int c = 0; c < 3; ++c)
            reflected[c] += static_cast<double>(problem.area[i]) * problem.reflectance[i][c];
    }
    if (area <= 0) return;
    area_ = area;
    for (int c = 0; c < 3; ++c) reflected_by_seen_[c] = static_cast<float>(reflected[c] / area);
    // Where nothing that is seen reflects, every patch counts by its power alone.
    if (max_channel(reflected_by_seen_) <= 0) reflected_by_seen_ = Rgb(1);
    least_weight_ = 0.01F * max_channel(reflected_by_seen_);
}

double ShooterChoice::contribution(Rgb light, std::size_t patch) const {
    const double area = problem_.area[patch];
    if (order_ == ShootingOrder::estimated) {
        Rgb weight = reflected_by_seen_;
        if (roles_.is_seen(patch)) weight -= static_cast<float>(area / area_) * problem_.reflectance[patch];
        light *= glm::max(weight, Rgb(least_weight_));
    }
    // In double because the product must not vanish while light is left.
    return static_cast<double>(max_channel(light)) * area;
}

int ShooterChoice::rank(std::size_t patch) const {
    if (order_ != ShootingOrder::report) return 0;
    if (!roles_.is_seen(patch)) return 2;
    return roles_.is_moving(patch) && max_channel(problem_.reflectance[patch]) >= high_reflectance ? 0 : 1;
}

std::vector<Index> ShooterChoice::next(std::span<const Rgb> unshot, std::span<const std::uint8_t> active,
                                       float least, double share) const {
    // Of patches that are not to be chosen: 0.
    std::vector<double> contributed(unshot.size());
    double largest = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < unshot.size(); ++i) {
        const Rgb light = glm::abs(unshot[i]);
        if (max_channel(light) <= least || (!active.empty() && active[i] == 0)) continue;
        contributed[i] = contribution(light, i);
        if (contributed[i] <= largest) continue;
        largest = contributed[i];
        first = i;
    }
    std::vector<Index> patches;
    if (largest <= 0) return patches;
    if (order_ == ShootingOrder::largest_first) return {static_cast<Index>(first)};

    int best_rank = rank(first);
    for (std::size_t i = 0; i < unshot.size(); ++i) {
        if (contributed[i] < share * largest || rank(i) > best_rank) continue;
        if (rank(i) < best_rank) {
            best_rank = rank(i);
            patches.clear();
        }
        patches.push_back(static_cast<Index>(i));
    }
    return patches;
}

}  // namespace afterglow
