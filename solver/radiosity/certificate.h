#pragma once

#include <span>

#include "solver/base/context.h"
#include "solver/base/math.h"
#include "solver/radiosity/problem.h"

namespace afterglow {

/// A promise about a solution B̂ = E + ρH: no patch's radiosity is further than `error_bound` from the exact
/// one. With the residual r = E + ρ (F B̂ + H0) − B̂, ‖B − B̂‖∞ ≤ ‖r‖∞ / (1 − g), the maximum taken over patches
/// and channels. Residual and bound are relative to the mean reflected light (mean_reflected), never to the
/// lamp.
struct Certificate {
    double residual = 0;     ///< ‖r‖∞, or a bound of it that includes rounding; relative
    double gain = 0;         ///< g, see Enclosure
    double error_bound = 0;  ///< residual / (1 − g) or less; infinity where g ≥ 1 and light is left
};

/// What residuals are relative to, W/m²: the area-weighted mean of ρH over patches that do not emit, its
/// largest channel. Where that is zero but for rounding (everything emits, or all else is black) the mean
/// over all patches; where that is zero too, 0: then nothing has been reflected yet, and a certificate says 0
/// if no light is left and infinity otherwise.
double mean_reflected(const RadiosityProblem& problem, std::span<const Rgb> irradiance);

/// The same from sums over some patches, added in a fixed order. In double, because thousands of small
/// patches must not vanish beside the sum so far.
class ReflectedMean {
  public:
    /// One patch with its ρH, W/m².
    void add(float area_m2, const Rgb& emission, const Rgb& reflected);
    /// What another has summed.
    void add(const ReflectedMean& other);
    [[nodiscard]] double value() const;

  private:
    struct Sum {
        double area = 0;
        double power[3] = {0, 0, 0};
        void add(const Sum& other);
        [[nodiscard]] double largest_channel() const;
    };
    Sum others_;    // of patches that do not emit
    Sum emitters_;  // of those that do
};

/// The certificate that follows from a residual given in W/m² and from mean_reflected.
Certificate make_certificate(double residual, double gain, double reflected);

/// Computes the residual of any solution, whoever made it: one gather over all rows. The single-precision
/// rounding of the sums is added to it, so it is never too small. Errors: invalid_input where the sizes do
/// not agree; cancelled. Same bits for any number of threads.
Certificate certify(const RadiosityProblem& problem, std::span<const Rgb> irradiance, const Context& context);

}  // namespace afterglow
