#pragma once

#include "solver/image/picture.h"
#include "solver/image/probes.h"
#include "solver/mesh/patch_mesh.h"
#include "solver/sequence/config.h"

namespace afterglow {

/// What a quality or an asked error stands for. See README.md for the figures behind the numbers.
struct QualityLevel {
    float cells = 1500;              ///< into which the reached surfaces are divided before any is refined
    float finest_share = 0.125F;     ///< of a cell's edge: no smaller patches; 1: all cells as they are
    float size_per_distance = 0.7F;  ///< see CoarsenessConfig
    int rays_per_patch = 256;        ///< where the settings name none
    double certificate = 0.02;       ///< relative error at which a solution is finished
    PictureConfig picture;           ///< its seed is the settings'
    float picture_tolerance = 0;     ///< see KeptPictureConfig::tolerance
    ProbeConfig probes;              ///< likewise; as many paths as the error to be told needs
};

/// By the asked error where that settles it (see SequenceConfig::asked_error), by quality otherwise.
/// Thread-safety: pure.
QualityLevel level_of(const SequenceConfig& config);

}  // namespace afterglow
