#pragma once

#include <optional>

#include "solver/formfactor/outside_light.h"
#include "solver/image/probes.h"
#include "solver/radiosity/progressive.h"
#include "solver/sequence/parts.h"

namespace afterglow {

/// One frame on its way: what its lines see so far and the light that follows. Refined by stages, each with
/// more lines or a smaller error. What the last stage gives does not depend on the stages before it.
class FrameRefinement {
  public:
    /// Places the actors where they are in a frame. Keeps a reference to `parts`.
    FrameRefinement(SequenceState::Parts& parts, int frame);

    /// Looks along the first `directions` sight lines of every patch, where that is more than before.
    void look(Index directions, VisibilityStrategy& strategy, const Context& context);
    /// Solves, from nothing, until the certificate is met.
    void solve(double asked_error, const Context& context);
    /// Solves as the sequence's solution does, from what the last frame left if it keeps anything, likewise.
    /// All lines must have been looked along.
    void solve_finally(double asked_error, const Context& context);
    /// What is solved so far, with an estimate of the light still on its way.
    Picture preliminary_picture(int width, int height, const Context& context);
    Picture final_picture(const Context& context);
    /// How far the final picture is off. Probed once.
    const ProbeEstimate& probe(const Picture& final_picture, const Context& context);
    /// The same with the noise of lines, noted in the statistics.
    void estimate_error(const Picture& final_picture, const Context& context);

    [[nodiscard]] const Certificate& certificate() const { return certificate_; }
    /// Whether single precision was too coarse for the latest solution's asked error.
    [[nodiscard]] bool exhausted() const { return exhausted_; }
    [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }
    /// Counts what an earlier form of the same frame has cost as well.
    void add_cost(const FrameStatistics& earlier);

  private:
    void compile(const Context& context);
    void light_from_outside(std::span<const float> valid_share, std::span<const float> sky,
                            const Context& context);
    void prepare_rows(const Context& context);
    void follow_layers(double asked_error, const Context& context);
    void follow_changes(double asked_error, const Context& context);
    void follow_active(double asked_error, const Context& context);
    void follow_view(double asked_error, const Context& context);
    void change_incremental(std::optional<KeptRows>& kept, const Context& context);
    [[nodiscard]] std::vector<Index> rows_changed(const KeptRows& kept, const Context& context) const;
    void take_rows_light(const ProgressiveState& light, std::uint64_t shots_before);
    void note_solution(std::uint64_t shots);
    [[nodiscard]] RadiosityProblem problem() const;
    [[nodiscard]] std::vector<Rgb> irradiance_from_lamps() const;
    [[nodiscard]] std::vector<Rgb> indirect_irradiance() const;
    [[nodiscard]] std::vector<Rgb> radiosity() const;
    [[nodiscard]] DirectLight direct_light() const;
    [[nodiscard]] LitWorld lit_by(std::span<const Rgb> irradiance) const;

    SequenceState::Parts& parts_;
    int frame_;
    double time_s_;
    std::vector<LightInPlace> lights_;
    std::vector<Material> materials_;
    std::vector<Rgb> emission_, reflectance_;
    std::vector<Rgb> from_lights_;  ///< irradiance by the lights without a surface
    std::vector<Rgb> outside_;      ///< and by the sky
    Index directions_ = 0;
    std::shared_ptr<const CompiledRows> rows_;
    std::optional<ProgressiveState> light_;
    std::vector<Rgb> irradiance_;     ///< of the latest solution
    std::vector<Rgb> from_lamps_;     ///< the part of it that comes from lamps straight
    std::vector<float> valid_share_;  ///< by patch, of its lines
    bool exhausted_ = false;
    Certificate certificate_;
    std::optional<ProbeEstimate> probed_;
    FrameStatistics statistics_;
};

}  // namespace afterglow
