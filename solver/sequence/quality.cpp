#include "solver/sequence/quality.h"

#include "solver/sequence/asked_error.h"

namespace afterglow {

namespace {

QualityLevel level_for(Quality quality) {
    QualityLevel level;
    switch (quality) {
        case Quality::draft:
            level.finest_share = 1;
            level.rays_per_patch = 128;
            level.picture = {1, 4, 2, 0.1F};
            level.picture_tolerance = 0.01F;
            level.probes.samples_per_part = 8;
            level.probes.paths_per_sample = 2;
            break;
        case Quality::preview:
            level.picture = {4, 16, 2, 0.07F};
            level.picture_tolerance = 0.0025F;
            break;
        case Quality::final:
            level.cells = 6000;
            level.rays_per_patch = 512;
            level.picture = {8, 64, 4, 0.02F};
            level.picture_tolerance = 0.001F;
            // Half the error is a quarter of its square, to be told from noise that must be so much smaller.
            level.probes.parts = 24;
            level.probes.samples_per_part = 32;
            level.probes.paths_per_sample = 4;
            break;
    }
    return level;
}

}  // namespace

QualityLevel level_of(const SequenceConfig& config) {
    QualityLevel level =
        error_settles_all(config)
            ? level_for_error(*config.asked_error, static_cast<double>(config.width) * config.height)
            : level_for(config.quality);
    if (config.asked_error) level.certificate = *config.asked_error;
    // Where each frame's light is solved anew, nothing of its picture depends on the frames before.
    if (config.solution == Solution::progressive) level.picture_tolerance = 0;
    if (config.picture_tolerance) level.picture_tolerance = static_cast<float>(*config.picture_tolerance);
    if (config.rays_per_patch) level.rays_per_patch = *config.rays_per_patch;
    level.picture.seed = config.seed;
    level.probes.seed = config.seed;
    return level;
}

}  // namespace afterglow
