#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/pixels.h"
#include "solver/base/stopwatch.h"
#include "solver/scene/world.h"
#include "solver/sequence/config.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// What one frame cost and how good it is (the `frames` entries of a report).
struct FrameStatistics {
    int frame = 0;
    Milliseconds visibility{}, solve{}, image{}, total{};
    std::uint64_t rays_traced = 0;
    std::uint64_t visibility_changes = 0;  ///< sight lines that see another patch than in the previous frame
    std::uint64_t shots = 0;
    std::uint64_t active_patches = 0;
    double residual = 0;                  ///< largest residual relative to the mean of ρH over non-emitters
    double error_bound = 0;               ///< the certificate: residual / (1 − gain)
    std::optional<double> picture_error;  ///< relative RMSE of the final picture, estimated if asked for
    std::optional<double> picture_error_spread;  ///< the estimate's standard error
    std::optional<double> line_noise;  ///< part of picture_error: noise of the sight lines, from two halves
};

/// What the whole job cost before its frames.
struct SequenceStatistics {
    std::string method;               ///< as method_name has it
    std::string method_reason;        ///< why, where the settings left it to the scene
    std::uint64_t patches = 0;        ///< all
    std::uint64_t actor_patches = 0;  ///< of them, on actors
    std::uint64_t sight_lines = 0;
    int rays_per_patch = 0;
    Milliseconds setup{};        ///< meshing and acceleration structures
    Milliseconds static_pass{};  ///< sight lines against the furniture, or reading them from the cache
    bool static_from_cache = false;
    std::vector<WorkAhead> work_ahead;  ///< what was done for ranges of frames at once
    /// Where an asked error settles everything, once it is known: the error that pictures are made for, the
    /// asked one or, in a scene where that takes more than usual, a smaller one.
    std::optional<double> made_for_error = {};
    /// Stops by which all pictures are brightened, once a frame has been computed.
    std::optional<float> exposure_ev = {};

    /// Time spent within `step` that is in no frame's total.
    [[nodiscard]] Milliseconds outside_frames() const { return static_pass + total(work_ahead); }
};

/// A picture on its way to a frame: linear radiance, and the same ready to be shown.
struct Revision {
    int frame = 0;
    int revision = 0;     ///< counts from 1 within its frame
    bool final = false;   ///< the last one of its frame
    double residual = 0;  ///< as in FrameStatistics
    Picture radiance;
    std::vector<std::uint8_t> srgb;                   ///< width × height × 3
    std::optional<double> picture_error = {};         ///< of final pictures, as in FrameStatistics
    std::optional<double> picture_error_spread = {};  ///< likewise
};
using RevisionSink = std::function<void(const Revision&)>;

/// Everything a job keeps from frame to frame. Movable; one thread at a time.
class SequenceState {
  public:
    SequenceState(SequenceState&&) noexcept;
    SequenceState& operator=(SequenceState&&) noexcept;
    ~SequenceState();

    [[nodiscard]] const SequenceStatistics& statistics() const;
    [[nodiscard]] const Warnings& warnings() const;
    /// What is solved, as the edits so far have left it.
    [[nodiscard]] const World& world() const;

    struct Parts;
    explicit SequenceState(std::unique_ptr<Parts> parts);
    [[nodiscard]] Parts& parts() { return *parts_; }

  private:
    std::unique_ptr<Parts> parts_;
};

/// Meshes the world and prepares its acceleration structures. The static pass itself happens within the first
/// `step`, where coarse pictures can already be shown. Errors: invalid_input naming a setting; not_found for
/// a camera; cannot_converge where the gain is 1 or more; cancelled.
SequenceState make_state(World world, const SequenceConfig& config, const Context& context);

/// Computes one frame (0 or more, in any order). Where an asked error settles everything, the first call
/// probes the picture of time 0, and where that is farther off than asked divides the world anew, more
/// finely. `on_revision` gets each better picture, the last one marked final; the same thread calls it. It
/// may be empty, and then no preliminary pictures are made; the final picture does not depend on that.
/// Errors: cancelled leaves the state usable for another step.
FrameStatistics step(SequenceState& state, int frame, const RevisionSink& on_revision,
                     const Context& context);

/// One call for a range of frames, first and last included.
std::vector<FrameStatistics> render_sequence(World world, const SequenceConfig& config, int first_frame,
                                             int last_frame, const RevisionSink& on_revision,
                                             const Context& context = Context());

/// The last frame of an animation: the last one that shows a time not after the scene's duration.
int last_frame_of(const World& world, const SequenceConfig& config);

}  // namespace afterglow
