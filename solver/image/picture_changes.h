#pragma once

#include "solver/image/kept_picture.h"

namespace afterglow {

/// What is no longer as a kept picture shows it, and where actors stand now.
struct PictureChanges {
    bool everything = false;            ///< all samples are to be looked at
    std::vector<char> covered;          ///< by tile: actors may cover it now
    std::vector<char> changed_cover;    ///< by tile: actors that changed may cover it now or did before
    std::vector<ShadowRegion> shadows;  ///< of all actors now
    std::vector<ShadowRegion> changed_shadows;  ///< of actors that moved, there and back
    /// By patch: its irradiance is another (bit 0), or its confidence (bit 1). Empty: none is.
    std::vector<char> patches;

    [[nodiscard]] bool any() const;
    /// Whether a tile may show something else.
    [[nodiscard]] bool touch(Index tile, const KeptTile& kept) const;
    /// Whether patches that make up a tile count for more or less than before.
    [[nodiscard]] bool weigh_otherwise(const KeptTile& kept) const;
};

/// Whether samples of a state are of any use for a picture of this camera, configuration and light.
bool can_be_kept(const KeptPictureState& state, const CameraView& view, const LitWorld& lit,
                 const PictureConfig& config);

/// Compares a state with the light and the poses of now, takes these over, and says what that changes. All of
/// it where the state is not whole.
PictureChanges take_over(KeptPictureState& state, const LitWorld& lit, float tolerance);

}  // namespace afterglow
