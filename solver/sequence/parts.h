#pragma once

#include <memory>
#include <optional>

#include "solver/base/hash.h"
#include "solver/formfactor/rows.h"
#include "solver/image/kept_picture.h"
#include "solver/mesh/interpolation.h"
#include "solver/radiosity/active_passive.h"
#include "solver/radiosity/in_view.h"
#include "solver/radiosity/residual.h"
#include "solver/sequence/sequence.h"
#include "solver/visibility/strategy.h"

namespace afterglow {

/// The matrix of the frame shown last and its light, kept for the next one.
struct KeptLight {
    LayeredMatrix matrix;
    std::optional<ResidualState> state;
};

/// Rows as lines show them while every body stands at one place.
struct CompiledRows {
    std::vector<Pose> poses;  ///< by body
    Index directions = 0;     ///< of every patch that they are made from
    FormFactors factors;
    FormFactorColumns columns;
};

/// What an in-view solution knows of the camera's path.
struct KeptView {
    GroupedRows rows;
    FrameSpan frames;                             ///< that it has looked at
    std::vector<std::uint8_t> seen;               ///< by group, in any of them
    std::optional<Certificate> certificate = {};  ///< of what is seen, once it is solved
};

/// The same for solutions that work on compiled rows. These stay while nothing but the camera moves.
struct KeptRows {
    std::shared_ptr<const CompiledRows> rows;
    std::optional<IncrementalState> incremental;
    std::optional<ActivePassiveState> active_passive;
    std::optional<KeptView> view;
};

/// An asked error whose keeping is still to be seen: `config.asked_error` becomes what pictures are made for.
struct Settling {
    double asked = 0;
    int tries_left = 2;  ///< to make everything finer
};

/// What a sequence keeps from frame to frame. Parts point at each other, so they stay where they are: behind
/// one pointer.
struct SequenceState::Parts {
    World world;
    SequenceConfig config;
    PlacedCamera camera;
    RayCaster caster;
    SideMask reached;  ///< the sides that have patches
    /// How far apart patches are, first as guessed before it is known which sides get any: found once, so
    /// that what is not changed is divided as before.
    std::optional<float> guessed_size_m, patch_size_m;
    PatchMesh mesh;
    std::optional<Interpolation> interpolation;
    std::optional<SmoothNormals> normals;
    Lamps lamps;
    std::optional<SightLines> sight;
    std::optional<LightLines> light;
    StaticLines background;
    Hash128 background_key;
    std::unique_ptr<VisibilityStrategy> strategy;
    std::vector<WorkAhead> earlier_work_ahead;  ///< of strategies that were replaced
    VisibleLines visible;
    /// Sight lines of the frame before whose changes are still to be counted; empty at first.
    std::vector<Index> visible_before;
    std::uint64_t frames_shown = 0;
    bool edited = false;                  ///< since the last of them
    std::optional<KeptLight> kept_light;  ///< of a solution that keeps it
    std::optional<KeptRows> kept_rows;    ///< likewise
    /// By patch, of before an edit, where `kept_light` is to start from; empty: from nothing.
    std::vector<std::optional<Lanes>> radiosity_before;
    KeptPictureState picture;          ///< the final one of the frame before; empty where the camera moves
    std::optional<float> exposure_ev;  ///< set once, for all frames
    std::optional<Settling> settling;  ///< as long as it is open what pictures are made for
    SequenceStatistics statistics;
    Warnings warnings;
    bool warned_of_exhaustion = false;  ///< one such warning a job is enough

    Parts(World world_in, const SequenceConfig& config_in)
        : world(std::move(world_in)), config(config_in), caster(world) {}

    [[nodiscard]] double frames_per_second() const {
        return config.frames_per_second > 0 ? config.frames_per_second : world.frames_per_second;
    }
    [[nodiscard]] double time_of(int frame) const { return frame / frames_per_second(); }
    [[nodiscard]] FrameClock clock() const { return {frames_per_second()}; }
    [[nodiscard]] LineScene lines(int frame) const {
        return {mesh, *sight, *light, caster, background, frame};
    }
    [[nodiscard]] LayerScene layers() const { return {mesh, *sight, *light, lamps, caster, background}; }
};

}  // namespace afterglow
