#include "tests/stability/follower.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/radiosity/exchange.h"

namespace afterglow::test {

namespace {

double brightest(const OwnedProblem& problem) {
    float light = 0;
    for (const Rgb& e : problem.emission) light = std::max(light, max_channel(e));
    return static_cast<double>(light);
}

}  // namespace

void PrintTo(Solving solving, std::ostream* out) {
    constexpr const char* names[] = {"cold", "incremental_sweeps", "incremental_shots", "active_passive"};
    *out << names[static_cast<int>(solving)];
}

Follower::Follower(Solving solving, double asked_error, int threads)
    : solving_(solving), asked_error_(asked_error), context_(threads), roles_(1, 0) {}

void Follower::begin(const OwnedProblem& problem) {
    roles_ = RandomRoles(3, problem.area.size());
    begun_ = true;
}

Certificate Follower::follow(const OwnedProblem& problem, std::span<const Index> rows) {
    const bool first = !begun_;
    if (first) begin(problem);
    const RadiosityProblem view = problem.view();
    const FormFactorColumns columns = columns_of(problem.matrix, context_);
    Certificate certificate;
    if (solving_ == Solving::active_passive) {
        ActivePassiveConfig config;
        config.asked_error = asked_error_;
        config.passive_share = 0.3;
        config.activations = 3;
        if (first)
            state_ = make_active_passive_state(view, roles_.view(), config, context_);
        else
            change(state_, view, rows, roles_.view(), config, context_);
        certificate = step(state_, view, columns, roles_.view(), config, context_);
    } else {
        ProgressiveConfig config = following_config(asked_error_);
        if (solving_ != Solving::incremental_shots) {
            config.finish = Finish::sweep;
            config.batch_share = 0.5;
        }
        IncrementalState& state = state_;
        if (first || solving_ == Solving::cold)
            state = make_incremental_state(view, context_);
        else
            change(state, view, rows, context_);
        certificate = step(state, view, columns, config, context_);
    }
    if (state_.status == ProgressiveStatus::exhausted) {
        // Allowed only where the promise asked for is as fine as the rounding of the brightest light.
        const double promise =
            asked_error_ * (1 - certificate.gain) * mean_reflected(view, state_.irradiance);
        EXPECT_LT(promise, 10 * gather_rounding * brightest(problem));
        return certificate;
    }
    EXPECT_EQ(state_.status, ProgressiveStatus::converged);
    EXPECT_LE(certificate.error_bound, asked_error_);
    return certificate;
}

double relative_error(const OwnedProblem& problem, const std::vector<Rgb>& irradiance) {
    const double error = largest_error(problem.view(), irradiance);
    return error == 0 ? 0 : error / mean_reflected(problem.view(), irradiance);
}

void expect_kept(const OwnedProblem& problem, const std::vector<Rgb>& irradiance,
                 const Certificate& certificate) {
    EXPECT_LE(relative_error(problem, irradiance), certificate.error_bound);
}

}  // namespace afterglow::test
