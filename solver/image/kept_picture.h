#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/base/context.h"
#include "solver/base/pixels.h"
#include "solver/image/kept_samples.h"

namespace afterglow {

struct KeptPictureConfig {
    PictureConfig picture;  ///< as for `render_picture`
    /// By how much a patch's irradiance may differ from what the picture shows, relative to the mean over all
    /// patches, before the picture follows it. Differences do not add up: it is compared with what was last
    /// used. 0: the picture follows every change.
    float tolerance = 0;
    /// Samples that would take more memory are not kept, and every picture is made from nothing.
    std::size_t most_bytes = std::size_t{1} << 30U;
};

/// What one update did.
struct PictureUpdate {
    bool anew = false;              ///< nothing could be kept
    std::uint64_t samples = 0;      ///< looked at
    std::uint64_t pixels = 0;       ///< lit again, with samples looked at or without
    std::uint64_t rays_traced = 0;  ///< of cameras and shadows
};

/// A picture and what is needed to bring it to another time: by camera sample what the furniture shows there.
/// About 140 bytes a sample. One thread at a time.
struct KeptPictureState {
    Picture picture;
    bool whole = false;  ///< `picture` is what the rest says; not so after a stop or before the first step

    CameraView view;
    PictureConfig config;
    PictureTiles tiling;
    std::vector<KeptTile> tiles;  ///< empty: samples are not kept
    // What the picture has been made from, all of it as it was last used.
    std::vector<Rgb> irradiance;              ///< by patch
    std::vector<float> confidence;            ///< likewise
    std::vector<Pose> poses;                  ///< by body
    std::vector<Box> boxes;                   ///< likewise, world; the furniture's too
    std::vector<std::vector<Index>> covered;  ///< likewise: tiles_covered
    std::vector<Material> materials;
    std::vector<LightInPlace> lights;
    std::optional<DirectLight> direct;
};

/// Makes `state.picture` what `render_picture` would make of the same light, to the bit: of `lit.irradiance`
/// where the tolerance is 0, else of `state.irradiance`. Frames may come in any order. While the camera
/// rests, only those samples are looked at again whose camera rays or shadow lines an actor's bounds can cut
/// now or could the last time, or whose patches have changed; where nothing has, nothing is done. Another
/// camera, configuration, material or light begins anew. World, mesh and what else `lit` points at must be
/// the same at every step, apart from poses. Same bits for any number of threads. Errors: cancelled; the
/// next step then begins anew.
PictureUpdate step(KeptPictureState& state, const CameraView& view, const LitWorld& lit,
                   const KeptPictureConfig& config, const Context& context);

}  // namespace afterglow
