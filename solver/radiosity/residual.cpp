#include "solver/radiosity/residual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "solver/base/error.h"
#include "solver/base/prefetch.h"
#include "solver/radiosity/residual_sums.h"
#include "solver/radiosity/residual_survey.h"

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 512;
// Rounds go on to this share of what is good enough, so that the exact survey after them is seldom the last
// but one.
constexpr double near_enough = 0.85;
// Rounds between two surveys that leave more than this share of the largest residual are too many.
constexpr double little_progress = 0.7;
// What the first solution is asked for, relative to what is asked: how far others' light may dim before what
// it leaves is too much.
constexpr double first_share = 0.5;

double gain_of(const ResidualProblem& problem) {
    double gain = 0;
    for (std::size_t i = 0; i < problem.matrix.rows(); ++i)
        gain = std::max(gain,
                        static_cast<double>(max_channel(problem.reflectance[i])) * problem.matrix.row_sum[i]);
    return gain;
}

/// Changes radiosity by the residuals and lets the rows know. What actors cover, and whole rows, learn of it
/// in the end only, once for many rounds: that changes little of what is pushed. Actors then answer before
/// those who see them learn of anything, so that light goes to them and back between two surveys.
class Pusher {
  public:
    Pusher(ResidualState& state, const ResidualProblem& problem, Surveyor& surveyor)
        : state_(state), problem_(problem), surveyor_(surveyor), work_(state.workspace) {
        work_.change.assign(state.radiosity.size(), {});
        work_.is_pushed.assign(state.radiosity.size(), 0);
        work_.by_sight.assign(problem.matrix.rows(), {});
        work_.by_light.assign(problem.matrix.rows(), {});
    }

    /// Returns whether any radiosity changed at all.
    bool push(const Survey& survey, const ResidualConfig& config, const Context& context) {
        bool moved = false;
        double largest = survey.largest;
        // What is covered will want a little more.
        const double enough = near_enough * survey.enough;
        ResidualState::Progress& progress = state_.progress;
        progress.largest_before = survey.largest;
        progress.rounds_made = 0;
        const int most = std::min(config.rounds_between_surveys, progress.rounds_allowed);
        for (int round = 0; round < most && largest > enough; ++round) {
            const std::vector<Index> patches =
                choose(std::max(config.push_share * largest, config.least_share * survey.enough));
            const bool sweeps =
                entries_of(patches) >= config.sweep_share * static_cast<double>(all_entries());
            // A sweep starts from residuals that are exact.
            if (sweeps && round > 0) break;
            ++state_.rounds;
            if (sweeps) return sweep(context);
            if (!push_along_columns(patches)) break;
            moved = true;
            ++progress.rounds_made;
            largest = surveyor_.look_again(context);
        }
        const bool answered = let_actors_answer(config.least_share * survey.enough, context);
        settle(context);
        // Whole rows have heard of all but what they answered.
        if (answered) gather_whole(state_, problem_, context);
        return moved || answered;
    }

  private:
    [[nodiscard]] std::vector<Index> choose(double threshold) const {
        std::vector<Index> patches;
        for (std::size_t i = 0; i < work_.magnitude.size(); ++i)
            if (static_cast<double>(work_.magnitude[i]) >= threshold)
                patches.push_back(static_cast<Index>(i));
        return patches;
    }
    [[nodiscard]] double entries_of(std::span<const Index> patches) const {
        const auto& sight = problem_.matrix.sight_columns.column_begin;
        const auto& light = problem_.matrix.light_columns.column_begin;
        std::uint64_t entries = 0;
        for (const Index i : patches) entries += sight[i + 1] - sight[i] + light[i + 1] - light[i];
        return static_cast<double>(entries);
    }
    [[nodiscard]] std::uint64_t all_entries() const {
        return problem_.matrix.sight.base.entries() + problem_.matrix.light.base.entries();
    }

    /// B takes up its residual; returns by how much it changed.
    DoubleLanes take_up(std::size_t i) {
        const Lanes before = state_.radiosity[i];
        const Lanes after{before.v + surveyor_.residual(i).v};
        const DoubleLanes change{to_double(after).v - to_double(before).v};
        // The fourth lane moves only where light does: nobody hears of it otherwise.
        if (!is_any(change)) return {};
        state_.radiosity[i] = after;
        work_.change[i].v += change.v;
        work_.residual[i].v -= to_single(change).v;
        ++state_.pushes;
        return change;
    }

    bool sweep(const Context& context) {
        const std::uint64_t before = state_.pushes;
        for (std::size_t i = 0; i < work_.residual.size(); ++i)
            if (work_.magnitude[i] > 0) take_up(i);
        ++state_.sweeps;
        if (state_.left.empty())
            gather_all(state_, problem_, context);
        else
            gather_reached(state_, problem_, work_.change, context);
        std::fill(work_.change.begin(), work_.change.end(), DoubleLanes{});
        gather_whole(state_, problem_, context);
        return state_.pushes > before;
    }

    bool push_along_columns(std::span<const Index> patches) {
        const std::uint64_t before = state_.pushes;
        DoubleLanes* const by_sight = work_.by_sight.data();
        DoubleLanes* const by_light = work_.by_light.data();
        const auto& of_lamps = problem_.matrix.light_columns;
        for (std::size_t p = 0; p < patches.size(); ++p) {
            if (p + 1 < patches.size())
                prefetch(column_entries(problem_.matrix.sight_columns, patches[p + 1]));
            const Index i = patches[p];
            const DoubleLanes change = take_up(i);
            if (!is_any(change)) continue;
            work_.is_pushed[i] = 1;
            state_.entries += problem_.matrix.sight_columns.column_begin[i + 1] -
                              problem_.matrix.sight_columns.column_begin[i] + of_lamps.column_begin[i + 1] -
                              of_lamps.column_begin[i];
            for_column(problem_.matrix.sight_columns, i,
                       [&](Index row, float lines) { add_light(by_sight[row], lines, change.v); });
            if (of_lamps.column_begin[i] == of_lamps.column_begin[i + 1]) continue;
            surveyor_.expect_from_lamps();
            for_column(of_lamps, i,
                       [&](Index row, float value) { add_light(by_light[row], value, change.v); });
        }
        return state_.pushes > before;
    }

    /// Whole rows hear of all pushes so far, and those that no column of the base knows, which are actors',
    /// take up what that leaves. Returns whether any did.
    bool let_actors_answer(double threshold, const Context& context) {
        bool answered = false;
        const std::vector<DoubleLanes> before = state_.by_whole;
        gather_whole(state_, problem_, context);
        const auto& of_sight = problem_.matrix.sight_columns.column_begin;
        const auto& of_light = problem_.matrix.light_columns.column_begin;
        for (std::size_t k = 0; k < before.size(); ++k) {
            const Index i = problem_.matrix.whole_rows[k];
            if (of_sight[i] != of_sight[i + 1] || of_light[i] != of_light[i + 1]) continue;
            const Lanes heard = to_single({state_.by_whole[k].v - before[k].v});
            work_.residual[i].v += surveyor_.reflectance(i).v * heard.v;
            if (static_cast<double>(surveyor_.magnitude(i, surveyor_.residual(i))) < threshold) continue;
            if (!is_any(take_up(i))) continue;
            work_.is_pushed[i] = 1;
            answered = true;
        }
        return answered;
    }

    /// Adds what is on its way to the sums of the layers.
    void settle(const Context& context) {
        const std::size_t blocks = problem_.matrix.sight.covered.size();
        context.for_chunks(blocks, rows_per_chunk / block_size, [&](std::size_t first, std::size_t last) {
            for (std::size_t b = first; b < last; ++b) {
                if (b + 1 < last) prefetch<CoveredEntry>(problem_.matrix.sight.covered[b + 1].entries);
                settle_block(b);
            }
        });
        std::fill(work_.change.begin(), work_.change.end(), DoubleLanes{});
        std::fill(work_.is_pushed.begin(), work_.is_pushed.end(), std::uint8_t{0});
    }

    using BlockSums = std::array<DoubleLanes, block_size>;
    void settle_block(std::size_t block) {
        const std::size_t begin = block * block_size;
        const std::size_t end = std::min(begin + block_size, problem_.matrix.rows());
        BlockSums sight, light{};
        for (std::size_t row = begin; row < end; ++row)
            sight[row - begin] = std::exchange(work_.by_sight[row], {});
        cover(problem_.matrix.sight, block, sight);
        // Lamps hardly reflect: mostly nothing has come from them.
        if (surveyor_.expects_from_lamps()) {
            for (std::size_t row = begin; row < end; ++row)
                light[row - begin] = std::exchange(work_.by_light[row], {});
            cover(problem_.matrix.light, block, light);
        }
        for (std::size_t row = begin; row < end; ++row)
            add_to_row(state_, problem_, row, sight[row - begin], light[row - begin]);
    }

    /// The columns of the base know nothing of what actors cover. Few patches are pushed, but which of the
    /// lines see one is a toss-up: picking those out first costs less than asking one by one.
    void cover(const LayeredRows& layer, std::size_t block, BlockSums& sums) const {
        const CoveredBlock& covered = layer.covered[block];
        const std::size_t size = covered.entries.size();
        std::array<Index, 256> picked;
        for (std::size_t begin = 0; begin < size; begin += picked.size()) {
            std::size_t count = 0;
            for (std::size_t k = begin; k < std::min(begin + picked.size(), size); ++k) {
                picked[count] = static_cast<Index>(k);
                const CoveredEntry& entry = covered.entries[k];
                count += work_.is_pushed[entry.now] | work_.is_pushed[entry.base()];
            }
            for (std::size_t p = 0; p < count; ++p) {
                const CoveredEntry& entry = covered.entries[picked[p]];
                add_light(sums[entry.lane()], covered.value.empty() ? 1.0F : covered.value[picked[p]],
                          work_.change[entry.now].v - work_.change[entry.base()].v);
            }
        }
    }

    ResidualState& state_;
    const ResidualProblem& problem_;
    Surveyor& surveyor_;
    ResidualState::Workspace& work_;
};

/// Single rounds with everything heard of after each always converge, since F has no negative entries and
/// gains are below 1.
void judge_rounds(ResidualState::Progress& progress, double largest) {
    if (largest > little_progress * progress.largest_before && progress.rounds_made > 1)
        progress.rounds_allowed = std::max(1, progress.rounds_made / 2);
    progress.largest_before = std::numeric_limits<double>::infinity();
}

void check(const ResidualProblem& problem, std::size_t state_size) {
    const std::size_t patches = problem.matrix.rows();
    const auto require = [&](std::size_t size, const char* field) {
        if (size != patches) throw Error(ErrorKind::invalid_input, field, "needs one value a patch");
    };
    require(problem.area.size(), "area");
    require(problem.emission.size(), "emission");
    require(problem.reflectance.size(), "reflectance");
    require(problem.external_irradiance.size(), "external irradiance");
    require(state_size, "state");
}

}  // namespace

ResidualState make_residual_state(const ResidualProblem& problem, const Context& context) {
    return make_residual_state(problem, std::vector<std::optional<Lanes>>(problem.matrix.rows()), context);
}

ResidualState make_residual_state(const ResidualProblem& problem, std::span<const std::optional<Lanes>> known,
                                  const Context& context) {
    const std::size_t patches = problem.matrix.rows();
    check(problem, known.size());
    ResidualState state;
    state.radiosity.resize(patches + 1);
    for (std::size_t i = 0; i < patches; ++i) {
        Lanes alone = to_lanes(problem.emission[i]);
        alone.v[3] = 1;
        state.radiosity[i] = known[i].value_or(alone);
    }
    state.by_sight.resize(patches);
    state.by_light.resize(patches);
    state.irradiance.assign(patches, Rgb(0));
    state.wear.assign(patches, 0);
    gather_all(state, problem, context);
    return state;
}

void follow(ResidualState& state, const ResidualProblem& problem, std::span<const RowChanges> changes,
            const Context& context) {
    check(problem, state.irradiance.size());
    const auto apply = [&](std::span<const RowChange> list, std::vector<DoubleLanes>& sums) {
        for (const RowChange& change : list) {
            add_light(sums[change.row], change.value,
                      to_double(state.radiosity[change.to]).v - to_double(state.radiosity[change.from]).v);
        }
    };
    context.for_chunks(changes.size(), 1, [&](std::size_t part, std::size_t) {
        apply(changes[part].sight, state.by_sight);
        apply(changes[part].light, state.by_light);
    });
}

Certificate step(ResidualState& state, const ResidualProblem& problem, const ResidualConfig& config,
                 const Context& context) {
    check(problem, state.irradiance.size());
    if (!(config.asked_error > 0)) throw Error(ErrorKind::invalid_input, "asked error", "must be above 0");
    const double gain = gain_of(problem);
    if (!(gain < 1))
        throw Error(ErrorKind::cannot_converge, "reflectance",
                    "a patch reflects " + std::to_string(gain) +
                        " of the light around it; at 1 or more the light would grow without bound");
    if (state.status != ResidualStatus::running) state.progress = {};
    state.status = ResidualStatus::running;
    gather_whole(state, problem, context);
    Surveyor surveyor(state, problem);
    Pusher pusher(state, problem, surveyor);
    const std::uint64_t pushes_before = state.pushes;
    const double asked = (state.left.empty() ? first_share : 1) * config.asked_error;
    for (;;) {
        const Survey survey = surveyor.look(gain, asked, context);
        judge_rounds(state.progress, survey.largest);
        const bool is_met = survey.certificate.error_bound <= asked;
        const bool may_go_on = state.pushes - pushes_before < config.max_pushes;
        context.check_stop();
        if (is_met || survey.only_rounding || (may_go_on && !pusher.push(survey, config, context))) {
            const bool is_enough = survey.certificate.error_bound <= config.asked_error;
            state.status = is_enough ? ResidualStatus::converged : ResidualStatus::exhausted;
            state.left = state.workspace.residual;
            return survey.certificate;
        }
        if (!may_go_on) return survey.certificate;
    }
}

}  // namespace afterglow
