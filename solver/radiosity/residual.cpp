#include "solver/radiosity/residual.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "solver/base/error.h"

namespace afterglow {

namespace {

constexpr std::size_t rows_per_chunk = 512;
// Additions after which a row's sums are computed afresh, so that rounding never accumulates.
constexpr std::uint8_t most_wear = 64;
// Rounds go on to this share of what is good enough, so that the exact survey after them is seldom the last
// but one.
constexpr double near_enough = 0.8;

bool is_any(const DoubleLanes& light) {
    return light.v[0] != 0 || light.v[1] != 0 || light.v[2] != 0;
}

void add_light(DoubleLanes& sum, float value, const DoubleLanes::Vector& light) {
    sum.v += static_cast<double>(value) * light;
}

/// What a row of a layer gathers, computed afresh.
DoubleLanes gather_layer(const LayeredRows& layer, std::size_t row, std::span<const Lanes> radiosity) {
    DoubleLanes sum = gather_row(layer.base, row, radiosity);
    for (const CoveredEntry& entry : layer.covered[row])
        add_light(sum, entry.value, to_double(radiosity[entry.now]).v - to_double(radiosity[entry.base]).v);
    return sum;
}

void gather_rows(ResidualState& state, const ResidualProblem& problem, std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
        state.by_sight[row] = gather_layer(problem.matrix.sight, row, state.radiosity);
        state.by_light[row] = gather_layer(problem.matrix.light, row, state.radiosity);
        // They began together; each is computed afresh in its own turn.
        state.wear[row] = static_cast<std::uint8_t>(row % most_wear);
    }
}

void gather_all(ResidualState& state, const ResidualProblem& problem, const Context& context) {
    context.for_chunks(problem.matrix.rows(), rows_per_chunk / 4, [&](std::size_t first, std::size_t last) {
        gather_rows(state, problem, first, last);
    });
}

void gather_whole(ResidualState& state, const ResidualProblem& problem, const Context& context) {
    state.by_whole.resize(problem.matrix.whole_rows.size());
    context.for_chunks(state.by_whole.size(), rows_per_chunk / 8, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
            state.by_whole[k] = gather_row(problem.matrix.whole, k, state.radiosity);
    });
}

double gain_of(const ResidualProblem& problem) {
    double gain = 0;
    for (std::size_t i = 0; i < problem.matrix.rows(); ++i)
        gain = std::max(gain,
                        static_cast<double>(max_channel(problem.reflectance[i])) * problem.matrix.row_sum[i]);
    return gain;
}

/// Where a solution stands; a function of the state alone.
struct Survey {
    double largest = 0;  ///< ‖r‖∞, W/m²
    double enough = 0;   ///< ‖r‖∞ that would meet the asked error
    Certificate certificate;
    bool only_rounding = false;
};

/// Computes irradiance and residual of all patches from the sums.
class Surveyor {
  public:
    Surveyor(ResidualState& state, const ResidualProblem& problem)
        : state_(state), problem_(problem), whole_(state.workspace.place_of_whole) {
        whole_.assign(problem.matrix.rows(), no_index);
        for (std::size_t k = 0; k < problem.matrix.whole_rows.size(); ++k)
            whole_[problem.matrix.whole_rows[k]] = static_cast<Index>(k);
    }

    /// All there is to know.
    Survey look(double gain, double asked_error, const Context& context) {
        std::vector<Part> parts((whole_.size() + rows_per_chunk - 1) / rows_per_chunk);
        context.for_chunks(whole_.size(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
            parts[first / rows_per_chunk] = look_at(first, last);
        });
        Part all;
        for (const Part& part : parts) {
            all.largest = std::max(all.largest, part.largest);
            all.brightest = std::max(all.brightest, part.brightest);
            all.mean.add(part.mean);
        }
        const double left = gain * static_cast<double>(all.largest);
        const double rounding = gather_rounding * static_cast<double>(all.brightest);
        const double mean = all.mean.value();
        Survey survey;
        survey.largest = all.largest;
        survey.enough = gain > 0 ? std::max(asked_error * mean * (1 - gain) - rounding, 0.0) / gain : 0;
        survey.certificate = make_certificate(left + rounding, gain, mean);
        survey.only_rounding = 8 * left <= rounding;
        return survey;
    }

    /// The residuals alone, and the largest of them, while this is still on its way to the layers' sums.
    float look_again(std::span<const Lanes> by_sight, std::span<const Lanes> by_light,
                     const Context& context) {
        std::vector<float> largest((whole_.size() + rows_per_chunk - 1) / rows_per_chunk);
        context.for_chunks(whole_.size(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
            float here = 0;
            for (std::size_t i = first; i < last; ++i) {
                const Lanes::Vector received = problem_.matrix.sight.scale[i] * by_sight[i].v +
                                               problem_.matrix.light.scale[i] * by_light[i].v;
                state_.residual[i] = problem_.emission[i] +
                                     problem_.reflectance[i] * (state_.irradiance[i] + to_rgb({received})) -
                                     to_rgb(state_.radiosity[i]);
                here = std::max(here, max_channel(glm::abs(state_.residual[i])));
            }
            largest[first / rows_per_chunk] = here;
        });
        return *std::max_element(largest.begin(), largest.end());
    }

  private:
    struct Part {
        float largest = 0;    // residual
        float brightest = 0;  // reflected
        ReflectedMean mean;
    };

    Part look_at(std::size_t first, std::size_t last) {
        const LayeredMatrix& matrix = problem_.matrix;
        Part part;
        for (std::size_t i = first; i < last; ++i) {
            DoubleLanes::Vector sum = static_cast<double>(matrix.sight.scale[i]) * state_.by_sight[i].v +
                                      static_cast<double>(matrix.light.scale[i]) * state_.by_light[i].v;
            if (whole_[i] != no_index) sum += state_.by_whole[whole_[i]].v;
            const Rgb irradiance =
                to_rgb({__builtin_convertvector(sum, Lanes::Vector)}) + problem_.external_irradiance[i];
            const Rgb reflected = problem_.reflectance[i] * irradiance;
            state_.irradiance[i] = irradiance;
            state_.residual[i] = problem_.emission[i] + reflected - to_rgb(state_.radiosity[i]);
            part.largest = std::max(part.largest, max_channel(glm::abs(state_.residual[i])));
            part.brightest = std::max(part.brightest, max_channel(glm::abs(reflected)));
            part.mean.add(problem_.area[i], problem_.emission[i], reflected);
        }
        return part;
    }

    ResidualState& state_;
    const ResidualProblem& problem_;
    std::vector<Index>& whole_;  // where a row stands among the whole ones
};

/// Changes radiosity by the residuals and lets the rows know. What actors cover, and whole rows, learn of it
/// in the end only, once for many rounds: that changes little of what is pushed.
class Pusher {
  public:
    Pusher(ResidualState& state, const ResidualProblem& problem, Surveyor& surveyor)
        : state_(state),
          problem_(problem),
          surveyor_(surveyor),
          change_(state.workspace.change),
          is_pushed_(state.workspace.is_pushed),
          by_sight_(state.workspace.by_sight),
          by_light_(state.workspace.by_light) {
        change_.assign(state.radiosity.size(), {});
        is_pushed_.assign(state.radiosity.size(), 0);
        by_sight_.assign(problem.matrix.rows(), {});
        by_light_.assign(problem.matrix.rows(), {});
    }

    /// Returns whether any radiosity changed at all.
    bool push(const Survey& survey, const ResidualConfig& config, const Context& context) {
        bool moved = false;
        double largest = survey.largest;
        // What is covered will want a little more.
        const double enough = near_enough * survey.enough;
        for (int round = 0; round < config.rounds_between_surveys && largest > enough; ++round) {
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
            largest = surveyor_.look_again(by_sight_, by_light_, context);
        }
        settle(context);
        return moved;
    }

  private:
    [[nodiscard]] std::vector<Index> choose(double threshold) const {
        std::vector<Index> patches;
        for (std::size_t i = 0; i < state_.residual.size(); ++i)
            if (static_cast<double>(max_channel(glm::abs(state_.residual[i]))) >= threshold)
                patches.push_back(static_cast<Index>(i));
        return patches;
    }
    [[nodiscard]] double entries_of(std::span<const Index> patches) const {
        std::uint64_t entries = 0;
        for (const LayeredRows* layer : {&problem_.matrix.sight, &problem_.matrix.light})
            for (const Index i : patches)
                entries += layer->columns.column_begin[i + 1] - layer->columns.column_begin[i];
        return static_cast<double>(entries);
    }
    [[nodiscard]] std::uint64_t all_entries() const {
        return problem_.matrix.sight.base.entries() + problem_.matrix.light.base.entries();
    }

    /// B takes up its residual; returns by how much it changed, exactly.
    Lanes take_up(std::size_t i) {
        const Lanes before = state_.radiosity[i];
        state_.radiosity[i] = to_lanes(to_rgb(before) + state_.residual[i]);
        const DoubleLanes::Vector change = to_double(state_.radiosity[i]).v - to_double(before).v;
        change_[i].v += change;
        state_.pushes += is_any({change}) ? 1 : 0;
        return {__builtin_convertvector(change, Lanes::Vector)};
    }

    bool sweep(const Context& context) {
        const std::uint64_t before = state_.pushes;
        for (std::size_t i = 0; i < state_.residual.size(); ++i) take_up(i);
        std::fill(change_.begin(), change_.end(), DoubleLanes{});
        ++state_.sweeps;
        gather_all(state_, problem_, context);
        gather_whole(state_, problem_, context);
        return state_.pushes > before;
    }

    bool push_along_columns(std::span<const Index> patches) {
        const std::uint64_t before = state_.pushes;
        for (const Index i : patches) {
            const Lanes change = take_up(i);
            is_pushed_[i] = 1;
            send(problem_.matrix.sight.columns, i, change.v, by_sight_);
            if (send(problem_.matrix.light.columns, i, change.v, by_light_)) lamps_changed_ = true;
        }
        return state_.pushes > before;
    }

    /// Returns whether the column has any entries.
    static bool send(const FormFactorColumns& columns, Index i, const Lanes::Vector& change,
                     std::span<Lanes> received) {
        const std::uint64_t begin = columns.column_begin[i], end = columns.column_begin[i + 1];
        for (std::uint64_t e = begin; e < end; ++e) received[columns.row[e]].v += columns.value[e] * change;
        return begin < end;
    }

    /// Adds what is on its way to the sums.
    void settle(const Context& context) {
        context.for_chunks(problem_.matrix.rows(), rows_per_chunk, [&](std::size_t first, std::size_t last) {
            for (std::size_t row = first; row < last; ++row) {
                DoubleLanes sight = to_double(by_sight_[row]), light;
                by_sight_[row] = {};
                cover(problem_.matrix.sight.covered[row], sight);
                // Lamps hardly reflect: mostly nothing has come from them.
                if (lamps_changed_) {
                    light = to_double(by_light_[row]);
                    by_light_[row] = {};
                    cover(problem_.matrix.light.covered[row], light);
                }
                if (!is_any(sight) && !is_any(light)) continue;
                state_.by_sight[row].v += sight.v;
                state_.by_light[row].v += light.v;
                if (++state_.wear[row] >= most_wear) gather_rows(state_, problem_, row, row + 1);
            }
        });
        std::fill(change_.begin(), change_.end(), DoubleLanes{});
        std::fill(is_pushed_.begin(), is_pushed_.end(), std::uint8_t{0});
        lamps_changed_ = false;
        gather_whole(state_, problem_, context);
    }

    /// The columns of the base know nothing of what actors cover.
    void cover(std::span<const CoveredEntry> covered, DoubleLanes& sum) const {
        for (const CoveredEntry& entry : covered)
            // Few patches are pushed, and these bytes stay near at hand.
            if ((is_pushed_[entry.now] | is_pushed_[entry.base]) != 0)
                add_light(sum, entry.value, change_[entry.now].v - change_[entry.base].v);
    }

    ResidualState& state_;
    const ResidualProblem& problem_;
    Surveyor& surveyor_;
    // See ResidualState::Workspace.
    std::vector<DoubleLanes>& change_;
    std::vector<std::uint8_t>& is_pushed_;
    std::vector<Lanes>& by_sight_;
    std::vector<Lanes>& by_light_;
    bool lamps_changed_ = false;  // something is on its way to the light layer
};

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
    const std::size_t patches = problem.matrix.rows();
    check(problem, patches);
    ResidualState state;
    state.radiosity.resize(patches + 1);
    for (std::size_t i = 0; i < patches; ++i) state.radiosity[i] = to_lanes(problem.emission[i]);
    state.by_sight.resize(patches);
    state.by_light.resize(patches);
    state.irradiance.assign(patches, Rgb(0));
    state.residual.assign(patches, Rgb(0));
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
    state.status = ResidualStatus::running;
    gather_whole(state, problem, context);
    Surveyor surveyor(state, problem);
    Pusher pusher(state, problem, surveyor);
    const std::uint64_t pushes_before = state.pushes;
    for (;;) {
        const Survey survey = surveyor.look(gain, config.asked_error, context);
        if (survey.certificate.error_bound <= config.asked_error)
            state.status = ResidualStatus::converged;
        else if (survey.only_rounding)
            state.status = ResidualStatus::exhausted;
        if (state.status != ResidualStatus::running || state.pushes - pushes_before >= config.max_pushes)
            return survey.certificate;
        context.check_stop();
        if (!pusher.push(survey, config, context)) {
            state.status = ResidualStatus::exhausted;
            return survey.certificate;
        }
    }
}

}  // namespace afterglow
