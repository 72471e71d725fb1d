#pragma once

#include <optional>

#include "solver/radiosity/progressive.h"
#include "solver/sequence/parts.h"

namespace afterglow {

/// One frame on its way: what its lines see so far and the light that follows. Refined by stages, each with
/// more lines or a smaller error. What the last stage gives does not depend on the stages before it.
class FrameRefinement {
  public:
    /// Places the actors at the frame's time. Keeps a reference to `parts`.
    FrameRefinement(SequenceState::Parts& parts, double time_s);

    /// Looks along the first `directions` sight lines of every patch, where that is more than before.
    void look(Index directions, VisibilityStrategy& strategy, const Context& context);
    /// Solves, from nothing, until the certificate is met.
    void solve(double asked_error, const Context& context);
    /// What is solved so far, with an estimate of the light still on its way.
    Picture preliminary_picture(int width, int height, const Context& context);
    Picture final_picture(const Context& context);

    [[nodiscard]] const Certificate& certificate() const { return certificate_; }
    [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }

  private:
    void compile(const Context& context);
    [[nodiscard]] RadiosityProblem problem() const;
    Picture picture(int width, int height, int samples, std::span<const Rgb> irradiance,
                    const Context& context);

    SequenceState::Parts& parts_;
    double time_s_;
    std::vector<Material> materials_;
    std::vector<Rgb> emission_, reflectance_, outside_;
    Index directions_ = 0;
    FormFactors factors_;
    FormFactorColumns columns_;
    std::optional<ProgressiveState> light_;
    Certificate certificate_;
    FrameStatistics statistics_;
};

}  // namespace afterglow
