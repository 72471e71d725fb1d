#pragma once

#include "solver/radiosity/residual.h"

namespace afterglow {

/// Where a solution stands; a function of the state alone.
struct Survey {
    double largest = 0;  ///< ‖r‖∞, W/m²
    double enough = 0;   ///< ‖r‖∞ that would meet the asked error
    Certificate certificate;
    bool only_rounding = false;
};

/// Computes irradiance and residual of all patches from the sums, for one call of `step`. Same bits for any
/// number of threads.
class Surveyor {
  public:
    /// Keeps references to its arguments.
    Surveyor(ResidualState& state, const ResidualProblem& problem);

    /// All there is to know, nothing being on its way. Errors: cancelled.
    Survey look(double gain, double asked_error, const Context& context);

    /// The magnitudes of the residuals alone, and the largest of them, while something is on its way to the
    /// layers' sums.
    float look_again(const Context& context);

    /// r of a patch with what is on its way to it, W/m².
    [[nodiscard]] Lanes residual(std::size_t i) const {
        Lanes::Vector r = work_.residual[i].v + work_.of_sight[i].v * to_single(work_.by_sight[i]).v;
        if (expects_from_lamps_) r += work_.of_light[i].v * to_single(work_.by_light[i]).v;
        return {r};
    }

    /// ρ of a patch, and of its largest channel.
    [[nodiscard]] Lanes reflectance(std::size_t i) const;

    /// As Workspace::magnitude has it, of a residual.
    [[nodiscard]] float magnitude(std::size_t i, const Lanes& residual) const;

    /// Something is on its way to the light layer, too, until the next `look`.
    void expect_from_lamps() { expects_from_lamps_ = true; }
    [[nodiscard]] bool expects_from_lamps() const { return expects_from_lamps_; }

  private:
    struct Part {
        float largest = 0;    // residual
        float brightest = 0;  // reflected
        float amplified = 0;  // ρ F w, see ResidualState::radiosity
        float missing = -1;   // 1 + ρ F w − w
        ReflectedMean mean;

        // How many times the largest residual what is shown may be off.
        [[nodiscard]] double amplification(double gain) const;
    };
    Part look_at(std::size_t first, std::size_t last);

    ResidualState& state_;
    const ResidualProblem& problem_;
    ResidualState::Workspace& work_;
    bool expects_from_lamps_ = false;
    double enough_ = 0;  // of the last look
};

}  // namespace afterglow
